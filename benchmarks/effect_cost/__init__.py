"""What effects.py is made of: the list of effects, and builds of the core without the code of one."""
