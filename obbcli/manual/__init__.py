"""The manual: one Markdown file a topic, shipped with the package.

Its readers are `obbtree manual` and the forge, where the README links to the same files.
"""

from __future__ import annotations

import re
from pathlib import Path

TOPICS = (
    "tour",
    "ci",
    "commands",
    "options",
    "scenes",
    "overlap",
    "clearance",
    "intervals",
    "sweeps",
    "pictures",
    "python",
    "python-tour",
    "json",
    "answers",
    "accuracy",
    "extremes",
    "guarantees",
    "evidence",
    "formats",
    "step",
    "tree-files",
    "limits",
    "security",
    "paper",
    "speed",
    "developing",
    "decisions",
    "changes",
)
"""All topics, in the order in which they are listed: first steps, reference, background."""

FOLDER = Path(__file__).parent


def page(topic: str) -> str:
    """Return a topic's Markdown text.

    Args:
        topic: one of `TOPICS`.

    Raises:
        OSError: the file of the installed package is gone.
    """
    return (FOLDER / f"{topic}.md").read_text(encoding="utf-8")


def summary(topic: str) -> str:
    """Return the first sentence of a topic, which says what it is about, without Markdown."""
    opening = page(topic).split("\n\n")[1].replace("\n", " ")
    sentence = re.match(r".*?\.(?= |$)", opening)
    return (sentence[0] if sentence else opening).replace("`", "")
