"""
The only doors through which text of a spec reaches the output.
"""

import json
import re
from collections.abc import Sequence
from textwrap import indent, wrap

LINE_WIDTH = 100
_COMMENT_WIDTH = LINE_WIDTH - len("// ")


def c_comment(text: str) -> str:
    """
    Return *text* as part of a ``//`` comment: one line that cannot continue on the next.
    """
    line = re.sub(r"[\x00-\x1f\x7f]+", " ", text)
    return line.replace("??/", "?? /").rstrip("\\ ").strip()


def c_string(text: str) -> str:
    """
    Return *text* as the inside of a C string literal.
    """
    return json.dumps(c_comment(text).replace("??", "?\\?"))[1:-1]


def properties_value(text: str) -> str:
    """
    Return *text* as a value of library.properties: one line without HTML.

    The IDE's library manager may show it as HTML. A blank behind ``<`` makes a tag plain text;
    an address such as ``<ada@example.org>`` is no tag that anything knows, and stays.
    """
    line = re.sub(r"\s+", " ", c_comment(text))
    return re.sub(r"<(?![\w.+-]+@[\w.-]+>)(?=[A-Za-z/!?])", "< ", line)


def markdown(text: str) -> str:
    """
    Return *text* as a paragraph of Markdown that shows it as it is: no HTML, link or heading.

    Source: CommonMark 0.31, 2.4: a backslash before ASCII punctuation makes it plain.
    """
    plain = re.sub(r"([\\`*_{}\[\]<>#|~&!:@])", r"\\\1", c_comment(text))
    return re.sub(r"^(?=[-+=])", r"\\", re.sub(r"^(\d+)(?=[.)])", r"\1\\", plain))


def block(text: str, width: int = 0) -> str:
    """
    Return *text* indented by *width* spaces, without the line end that follows its last line.
    """
    return indent(text.rstrip("\n"), " " * width)


def more(text: str, width: int = 0) -> str:
    """
    Return *text* as `block` does, but behind a line end of its own; nothing if it is empty.

    For what may be empty: written as ``{{- text | more }}``, it then leaves no empty line.
    """
    lines = block(text, width)
    return f"\n{lines}" if lines else ""


def comment_lines(text: str) -> tuple[str, ...]:
    """
    Return *text* as lines of a ``//`` comment, each within the line width.
    """
    return tuple(c_comment(line) for line in wrap(c_comment(text), _COMMENT_WIDTH))


def tidy(text: str) -> str:
    """
    Return *text* with no blanks at line ends, no two empty lines in a row, one line end at its end.
    """
    lines = re.sub(r"[ \t]+$", "", text, flags=re.MULTILINE)
    return re.sub(r"\n{3,}", "\n\n", lines).strip("\n") + "\n"


def listed(names: Sequence[str], conjunction: str = "and") -> str:
    """
    Return *names*, at least one, as prose: ``B``, ``B and E``, ``B, E and H``.
    """
    *first, last = names
    return f"{', '.join(first)} {conjunction} {last}" if first else last


def hexadecimal(value: int) -> str:
    """
    Return *value*, 0 to 255, the way registers are written: ``0x0F``.
    """
    return f"0x{value:02X}"


def frequency(hertz: int) -> str:
    """
    Return *hertz* as people say it: ``16 MHz``, ``128 kHz``.
    """
    for unit, size in (("MHz", 1_000_000), ("kHz", 1_000)):
        if hertz >= size and hertz * 1_000 % size == 0:
            return f"{hertz / size:g} {unit}"
    return f"{hertz} Hz"
