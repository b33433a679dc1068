"""Pages of the manual for people: laid out on a terminal, the Markdown text elsewhere."""

from __future__ import annotations

import os
import re
from typing import TextIO

# Pictures, and links to other topics, lead nowhere on a terminal: their words are what remains.
_PICTURE = re.compile(r"!\[([^\]]*)\]\([^)]*\)")
_TOPIC_LINK = re.compile(r"(?<!!)\[([^\]]*)\]\((?!https?:)[^)]*\)")


def draw_page(text: str, file: TextIO) -> None:
    """Write a page of Markdown to a file, laid out where it is a terminal.

    `NO_COLOR` and `FORCE_COLOR` are honoured.

    Args:
        text: the Markdown text; links to other topics are relative.
        file: where it goes.

    Raises:
        OSError: the file cannot be written.
    """
    if not (file.isatty() or os.environ.get("FORCE_COLOR")):
        file.write(text)
        return
    from rich.console import Console
    from rich.markdown import Markdown

    shown = _TOPIC_LINK.sub(r"**\1**", _PICTURE.sub(r"*picture: \1*", text))
    Console(file=file, emoji=False).print(Markdown(shown, code_theme="ansi_dark"))
