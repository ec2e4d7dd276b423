"""Multifrontal Cholesky factorisation for frozen patterns of 3 x 3 vertex blocks."""
