"""Temperatures of a bearing from its losses, and play and preload over temperature."""
