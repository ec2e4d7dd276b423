"""Shader node trees across Blender versions."""

import bpy

#: From here on every material and world has nodes, and asking for them warns.
_ALWAYS_NODES = (5, 0, 0)


def node_tree(owner: bpy.types.Material | bpy.types.World) -> bpy.types.NodeTree:
    """The node tree of a material or world."""
    if bpy.app.version < _ALWAYS_NODES:
        owner.use_nodes = True
    return owner.node_tree
