"""The same motion by general tools: each takes (k, B0, v2, duration) and returns the last whole lap."""
