"""Search among designs of one recipe: which vary, by which figures they are limited and ranked."""
