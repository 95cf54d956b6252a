"""The motion of a recipe, one grammar for every kind of cam; the follower's position over the shaft angle."""
