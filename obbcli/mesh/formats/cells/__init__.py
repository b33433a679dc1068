"""Cells of finite elements: their faces, their surface, their parts."""
