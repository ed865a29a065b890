"""Contact of elastic bodies as half spaces: plain arrays in and out."""
