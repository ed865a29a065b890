"""Predictions beside published measurements, with one set of assumptions that was written down before the runs."""
