"""glTF 2.0 and GLB, with parts, skins and packed geometry."""
