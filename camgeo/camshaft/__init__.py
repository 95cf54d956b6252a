"""Camshafts: lobes of several cams on one shaft, made as one solid, and when they lift."""
