"""The full solution of a mixed-lubricated contact, and how the product's law compares with it."""
