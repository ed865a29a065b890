"""Forces on cage and outer ring over frequency, as levels of octaves and as sound; rattle of the cage (``trbdyn[sound]``)."""
