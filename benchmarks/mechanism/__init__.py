"""What shows the mechanism of the cage's whirl, and what goes beyond the paper; pure functions on results, and short runs."""
