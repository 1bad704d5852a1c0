"""
The YAML of a spec: read once, with the place of every value.
"""

import re
import stat
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedBase, CommentedMap, CommentedSeq
from ruamel.yaml.error import MarkedYAMLError, YAMLError

from stepgen.errors import StepgenError

Location = Sequence[str | int]
MAXIMUM_BYTES = 256 * 1024
MAXIMUM_DEPTH = 12
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]+")  # would make a mess of a terminal


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
        return f"{self.path}:{line + 1}:{column + 1}", _CONTROL.sub(" ", text)


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
            spec never needs (several documents, anchors, tags, deep nesting).
    """
    text = _read_text(path)
    try:
        tree = YAML(typ="rt", pure=True).load(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"{path}:{mark.line + 1}:{mark.column + 1}" if mark else str(path)
        raise StepgenError.of(_yaml_problem(error), place=place) from None
    except (YAMLError, RecursionError, ValueError) as error:
        raise StepgenError.of(f"cannot be read as YAML: {error}", place=str(path)) from None
    if not isinstance(tree, CommentedMap) or not tree:
        raise StepgenError.of(
            "holds no spec; a spec begins with `library:`, `board:` and `motors:`",
            place=f"{path}:1:1",
        )
    return Document(path, text, _plain(tree, path, (0, 0)), tree)


def _read_text(path: Path) -> str:
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
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        reason = "is not UTF-8; save the file with that encoding"
        raise StepgenError.of(reason, place=f"{path}:{line}:1") from None


def _yaml_problem(error: MarkedYAMLError) -> str:
    problem = str(error.problem or error.context or "is not well formed").splitlines()[0]
    if problem.startswith("found duplicate key"):
        key = problem.removeprefix("found duplicate key ").split(" with value")[0]
        return f"the key {key} is given twice; remove one of them"
    return f"is no YAML: {problem}"


def _plain(
    node: Any,  # noqa: ANN401 - YAML is any data
    path: Path,
    mark: tuple[int, int],
    depth: int = 0,
) -> Any:  # noqa: ANN401 - YAML is any data
    """
    Return *node*, which stands at *mark*, as dicts, lists and scalars of Python's own types.
    """
    place = f"{path}:{mark[0] + 1}:{mark[1] + 1}"
    if depth > MAXIMUM_DEPTH:
        raise StepgenError.of("is nested too deeply for a spec; remove a level", place=place)
    if _is_marked(node):
        raise StepgenError.of("tags and anchors have no use in a spec; remove it", place=place)
    if isinstance(node, CommentedMap):
        return {
            _scalar(key): _plain(value, path, node.lc.value(key), depth + 1)
            for key, value in node.items()
        }
    if isinstance(node, CommentedSeq):
        return [
            _plain(value, path, node.lc.item(index), depth + 1) for index, value in enumerate(node)
        ]
    return _scalar(node)


def _is_marked(node: Any) -> bool:  # noqa: ANN401 - YAML is any data
    """
    Tell whether *node* has a tag or an anchor, or takes over what stands elsewhere (``<<``).
    """
    marks = (getattr(getattr(node, name, None), "value", None) for name in ("tag", "anchor"))
    return any(marks) or bool(getattr(node, "merge", None))


def _scalar(value: Any) -> Any:  # noqa: ANN401 - YAML is any data
    for kind in (bool, int, float, str):
        if isinstance(value, kind):
            return kind(value)
    return value
