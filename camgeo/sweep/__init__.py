"""Search among designs, and study of one."""
