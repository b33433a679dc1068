"""Trees and contacts to look at: what is drawn, as plain arrays, and its GLB, HTML and PNG."""
