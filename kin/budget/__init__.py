"""What errors of dimensions do to the position of a follower and of a linkage, to first order."""
