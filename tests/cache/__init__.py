"""What commands keep on disk: never stale, never trusted, never in the way."""
