"""PLY: header, body and strips."""
