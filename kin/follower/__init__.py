"""Contact: the position of a follower on a contour at a shaft angle, and the motion error."""
