"""
The YAML of a spec: read once, with the place of every value.
"""

import re
import stat
from codecs import BOM_UTF8
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedBase, CommentedMap, CommentedSeq
from ruamel.yaml.constructor import RoundTripConstructor
from ruamel.yaml.error import MarkedYAMLError

from stepgen.errors import StepgenError
from stepgen.spec.yaml_guard import HIDDEN, hidden_character, unwanted

Location = Sequence[str | int]
MAXIMUM_BYTES = 64 * 1024
LINE_END = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True)
class Document:
    """
    A spec's YAML as plain data, and where each part of it stands.
    """

    path: Path
    text: str
    data: Mapping[str, Any]
    tree: CommentedBase

    def place(self, location: Location) -> tuple[str, str]:
        """
        Return ``file:line:column`` and the text of the value at *location*.

        Elements of *location* that the YAML does not have (a union's tag, a missing field,
        a field that a short form stands for) are passed over: the place is then the nearest
        enclosing one that exists.
        """
        node: Any = self.tree
        line, column = node.lc.line, node.lc.col
        on_key = True
        for step in location:
            mark = _mark(node, step)
            if mark is None:
                continue
            line, column = mark
            node = node[step]
            on_key = isinstance(node, CommentedBase)
        text = "" if on_key or node is None else f"{_scalar(node)!s:.80}"
        return _place(self.path, line, column), " ".join(text.split())


def _mark(node: object, step: str | int) -> tuple[int, int] | None:
    mark: tuple[int, int] | None = None
    if isinstance(node, CommentedMap) and step in node:
        on_key = node[step] is None or isinstance(node[step], CommentedBase)
        mark = node.lc.key(step) if on_key else node.lc.value(step)
    elif isinstance(node, CommentedSeq) and isinstance(step, int) and step < len(node):
        mark = node.lc.item(step)
    return mark


def read_document(path: Path) -> Document:
    """
    Read the YAML file *path*.

    Raises:
        StepgenError: It cannot be read, is too large, is no YAML mapping, or holds what a
            spec never needs (see `stepgen.spec.yaml_guard.unwanted`).
    """
    text = _read_text(path)
    try:
        refused = unwanted(text)
        tree = None if refused else _yaml().load(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = _place(path, mark.line, mark.column) if mark else str(path)
        raise StepgenError.of(_yaml_problem(error), place=place) from None
    except Exception as error:  # noqa: BLE001 - ruamel.yaml lets ValueError and others out
        reason = f"cannot be read as YAML ({error}); compare it with a spec that can"
        raise StepgenError.of(reason, place=_place(path, 0, 0)) from None
    if refused:
        (line, column), reason = refused
        raise StepgenError.of(reason, place=_place(path, line, column))
    if not isinstance(tree, CommentedMap) or not tree:
        raise StepgenError.of(
            "holds no spec; a spec begins with `library:`, `board:` and `motors:`",
            place=_place(path, 0, 0),
        )
    return Document(path, text, _plain(tree), tree)


def _place(path: Path, line: int, column: int) -> str:
    return f"{path}:{line + 1}:{column + 1}"


class _Constructor(RoundTripConstructor):
    """
    Ruamel's, but a date stays the text that it is.
    """


_Constructor.add_constructor("tag:yaml.org,2002:timestamp", RoundTripConstructor.construct_scalar)


def _yaml() -> YAML:
    yaml = YAML(typ="rt", pure=True)
    yaml.Constructor = _Constructor
    return yaml


def read_bytes(path: Path) -> bytes:
    """
    Return what the file *path* holds, if it may be a spec.

    Raises:
        StepgenError: It is no regular file, cannot be read, or is larger than `MAXIMUM_BYTES`.
    """
    try:
        if not stat.S_ISREG(path.stat().st_mode) and not path.is_dir():
            reason = "is no regular file; name the YAML file of a spec"
            raise StepgenError.of(reason, place=str(path))
        with path.open("rb") as stream:
            raw = stream.read(MAXIMUM_BYTES + 1)
    except OSError as error:
        reason = f"cannot be read ({error.strerror}); name the YAML file of a spec"
        raise StepgenError.of(reason, place=str(path)) from None
    if len(raw) > MAXIMUM_BYTES:
        reason = f"is larger than {MAXIMUM_BYTES // 1024} KiB; a spec is a few dozen lines"
        raise StepgenError.of(reason, place=str(path))
    return raw


def _read_text(path: Path) -> str:
    raw = read_bytes(path).removeprefix(BOM_UTF8)  # a decoder that skips it counts from there
    try:
        text = raw.decode()
    except UnicodeDecodeError as error:
        reason = "is not UTF-8; save the file with that encoding"
        before = raw[: error.start].decode()
        raise StepgenError.of(reason, place=_place(path, *_end(before))) from None
    reason = hidden_character(text)
    if reason:
        before = HIDDEN.split(text, maxsplit=1)[0]
        raise StepgenError.of(reason, place=_place(path, *_end(before)))
    return text


def _end(text: str) -> tuple[int, int]:
    """
    Return line and column behind *text*, counted from 0.
    """
    lines = LINE_END.split(text)
    return len(lines) - 1, len(lines[-1])


def _yaml_problem(error: MarkedYAMLError) -> str:
    problem = str(error.problem or error.context or "is not well formed").splitlines()[0]
    if problem.startswith("found duplicate key"):
        key = problem.removeprefix("found duplicate key ").split(" with value")[0]
        return f"the key {key} is given twice; remove one of them"
    return f"is no YAML: {problem}; look at the quotes, brackets and indentation before it"


def _plain(node: Any) -> Any:  # noqa: ANN401 - YAML is any data
    """
    Return *node* as dicts, lists and scalars of Python's own types.
    """
    if isinstance(node, CommentedMap):
        return {_scalar(key): _plain(value) for key, value in node.items()}
    if isinstance(node, CommentedSeq):
        return [_plain(value) for value in node]
    return _scalar(node)


def _scalar(value: Any) -> Any:  # noqa: ANN401 - YAML is any data
    for kind in (bool, int, float, str):
        if isinstance(value, kind):
            return kind(value)
    return value
