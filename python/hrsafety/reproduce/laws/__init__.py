"""Laws beside each other."""
