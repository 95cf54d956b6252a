"""Jets, Taylor and interval arithmetic, Chebyshev interpolation, roots and extrema."""
