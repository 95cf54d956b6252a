"""A page to look at: the mechanism of a recipe turning, its curves, its checks; and still pictures of it."""
