"""Texts from users and files, as a terminal or a picture can show them."""

from __future__ import annotations


def printable(text: str, *, lines: bool = False) -> str:
    """A text with everything escaped that would end a line or move a terminal's cursor; `lines`: it may have several lines."""
    return "".join(sign if sign.isprintable() or (lines and sign == "\n") else ascii(sign)[1:-1] for sign in text)
