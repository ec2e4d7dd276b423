"""Between the solver's arrays and Blender's data: the one place where bpy and numpy meet."""
