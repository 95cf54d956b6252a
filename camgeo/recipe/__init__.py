"""The recipe: one topic of its keys a file, the whole in `recipe`, read by `loading`."""
