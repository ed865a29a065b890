"""Wear of raceways, rollers, ribs and pockets."""
