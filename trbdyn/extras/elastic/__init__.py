"""Elasticity of the cage: finite elements, natural modes and their file, stress from static loads."""
