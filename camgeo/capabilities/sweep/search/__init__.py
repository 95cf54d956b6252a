"""The search: many designs of one recipe, computed in chunks, kept by limits, ranked."""
