"""CSS text cut into rules, declarations and parts (CSS Syntax 3): strings, comments, brackets and escapes are
respected, and what is broken ends where a browser ends it. Everything takes linear time.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

_STRING = r'"(?:[^"\\\n]|\\[\s\S])*"?|' + r"'(?:[^'\\\n]|\\[\s\S])*'?"
_COMMENT = re.compile(rf"({_STRING})|/\*[\s\S]*?(?:\*/|\Z)|<!--|-->")
#: What has to be looked at when text is cut; an unquoted address may hold anything but a closing bracket.
_MARK = re.compile(rf"{_STRING}|\\[\s\S]?|[uU][rR][lL]\(\s*(?![\s\"'])[^)]*\)?|[;:,{{}}()\[\]]")
_ESCAPE = re.compile(r"\\(?:([0-9a-fA-F]{1,6})\s?|([\s\S]))")
_IMPORTANT = re.compile(r"!\s*important\s*\Z", re.IGNORECASE)
_CLOSING = {"(": ")", "[": "]", "{": "}"}


def without_comments(text: str) -> str:
    """``text`` with blanks for its comments, also for the marks that hide style sheets from old browsers."""
    return _COMMENT.sub(lambda match: match.group(1) or " ", text)


def split_parts(text: str, separator: str) -> list[str]:
    """``text`` cut at every ``separator`` (one of ``;:,``) that is in no string and no brackets."""
    if separator not in text:
        return [text]
    parts: list[str] = []
    start = 0
    for position, mark in _outer_marks(text):
        if mark == separator:
            parts.append(text[start:position])
            start = position + 1
    parts.append(text[start:])
    return parts


def split_rules(text: str) -> Iterator[tuple[str, str | None]]:
    """(what is before the block, the block's contents) of every rule; None for a statement such as @import."""
    start = position = 0
    while match := _MARK.search(text, position):
        mark, position = match.group(), match.end()
        if mark == "{":
            end = _closing(text, match.start())
            yield text[start : match.start()].strip(), text[position:end]
            start = position = end + 1
        elif mark == ";" and text[start : match.start()].lstrip().startswith("@"):
            yield text[start : match.start()].strip(), None
            start = position
        elif mark in ("(", "["):
            position = _closing(text, match.start()) + 1


def split_declarations(text: str) -> Iterator[tuple[str, str, bool]]:
    """(name, value, whether it is important) of every declaration. Names in lower case, but for ``--names``.

    Rules within rules are passed over.
    """
    if "/*" in text:
        text = without_comments(text)
    if "{" in text:
        text = "".join(_without_blocks(text))
    for part in split_parts(text, ";"):
        name, colon, value = part.partition(":")
        name, value = name.strip(), value.strip()
        if not colon or not name:
            continue
        important = False
        if "!" in value and (match := _IMPORTANT.search(value)):
            value, important = value[: match.start()].rstrip(), True
        yield name if name.startswith("--") else name.lower(), value, important


def unescape(name: str) -> str:
    """A name as it is meant: ``\\31 st`` is "1st"."""
    if "\\" not in name:
        return name

    def character(match: re.Match[str]) -> str:
        code = int(match.group(1) or "0", 16)
        if match.group(2) is not None:
            return match.group(2)
        return chr(code) if 0 < code < 0x110000 and not 0xD800 <= code < 0xE000 else "\ufffd"

    return _ESCAPE.sub(character, name)


def _outer_marks(text: str) -> Iterator[tuple[int, str]]:
    """(place, separator) outside all brackets."""
    open_: list[str] = []
    for match in _MARK.finditer(text):
        mark = match.group()
        if mark in _CLOSING:
            open_.append(_CLOSING[mark])
        elif open_:
            if mark == open_[-1]:
                open_.pop()
        elif mark in (";", ":", ","):
            yield match.start(), mark


def _closing(text: str, start: int) -> int:
    """The place of the bracket that closes the one at ``start``; the end of the text without one."""
    open_: list[str] = []
    for match in _MARK.finditer(text, start):
        mark = match.group()
        if mark in _CLOSING:
            open_.append(_CLOSING[mark])
        elif mark == open_[-1]:
            open_.pop()
            if not open_:
                return match.start()
    return len(text)


def _without_blocks(text: str) -> Iterator[str]:
    start = position = 0
    while match := _MARK.search(text, position):
        position = match.end()
        if match.group() == "{":
            # The block goes with whatever stands before it, back to the last declaration.
            head = text[start : match.start()]
            yield head[: head.rfind(";") + 1]
            start = position = _closing(text, match.start()) + 1
        elif match.group() in ("(", "["):
            position = _closing(text, match.start()) + 1
    yield text[start:]
