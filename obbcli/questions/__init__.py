"""The questions about two bodies, and what they share. Eberly 2008 §5 to §7."""
