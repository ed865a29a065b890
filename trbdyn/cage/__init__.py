"""Elasticity of the cage: a frame of beams, natural modes and their file, stress from static loads."""
