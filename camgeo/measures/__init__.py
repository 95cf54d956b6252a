"""What is measured of a design and its files: figures, limits, remarks, the follower train."""
