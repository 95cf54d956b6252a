"""What the mechanism does: motion laws, followers, contours read back from files, and the verdict."""
