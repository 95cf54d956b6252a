"""Linear cams: a plate that moves along a line under its follower, judged from its file."""
