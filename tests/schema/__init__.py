"""What the document is made of."""
