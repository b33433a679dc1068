"""Options that several commands share: words, placement, motion, accuracy."""
