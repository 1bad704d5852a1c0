"""
The marker inside a library that tells it is stepgen's: ``extras/stepgen.json``.
"""

import json
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path, PurePosixPath

from stepgen import __version__

MARKER = "extras/stepgen.json"
LARGEST_MARKER_BYTES = 1 << 20  # what is longer is none of stepgen's, and cut off no JSON
_GENERATOR = "stepgen"


def digest(content: bytes) -> str:
    """
    Return the checksum by which the marker knows a file's content.
    """
    return sha256(content).hexdigest()


def with_marker(files: Mapping[str, str]) -> dict[str, bytes]:
    """
    Return *files* as bytes, the marker among them, in the order of their paths.

    The marker names the generator, its version and each file's checksum: the same files give
    the same bytes.

    Raises:
        ValueError: A path of *files* leads out of the library, or is the marker's own.
    """
    contents = {path: text.encode() for path, text in files.items()}
    for path in contents:
        parts = PurePosixPath(path).parts
        if not parts or path == MARKER or parts[0] == "/" or ".." in parts:
            raise ValueError(f"{path!r} cannot be a file of a library")
    listed = {
        "generator": _GENERATOR,
        "version": __version__,
        "files": {path: digest(content) for path, content in contents.items()},
    }
    marker = json.dumps(listed, indent=2, sort_keys=True) + "\n"
    return dict(sorted({**contents, MARKER: marker.encode()}.items()))


def read_marker(folder: Path) -> dict[str, str] | None:
    """
    Return the checksum of each file that stepgen wrote into *folder*, by path.

    None where there is no marker, or what is there is none of stepgen's.
    """
    path = folder / MARKER
    if not path.is_file():
        return None
    with path.open("rb") as stream:
        return parse_marker(stream.read(LARGEST_MARKER_BYTES))


def parse_marker(content: bytes) -> dict[str, str] | None:
    """
    Return the checksums in a marker's *content*, or None where it is no marker of stepgen's.
    """
    try:
        listed = json.loads(content)
    except (ValueError, RecursionError):
        return None
    if not isinstance(listed, dict) or listed.get("generator") != _GENERATOR:
        return None
    files = listed.get("files")
    if not isinstance(files, dict) or not all(isinstance(known, str) for known in files.values()):
        return None
    return files
