"""
Chromium without a window, which shows a page, looks at it and prints it.
"""

import json
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

LOOK = Path(__file__).with_name("look.js")


def chromium(folder: Path, text: str, *options: str) -> str:
    """
    Show the page *text* in Chromium; return what that prints.
    """
    found = shutil.which("chromium")
    assert found, "there is no chromium; `make browser` installs it"
    (folder / "page.html").write_text(text, encoding="utf-8")
    return subprocess.run(
        [
            found,
            "--headless=new",
            "--no-sandbox",  # tests may run as root; the page has no script of its own
            "--disable-gpu",
            "--hide-scrollbars",
            "--no-first-run",
            f"--user-data-dir={folder / 'profile'}",
            *options,
            (folder / "page.html").as_uri(),
        ],
        check=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        encoding="utf-8",
        timeout=120,
    ).stdout


def looked_at(folder: Path, text: str, *options: str) -> dict[str, Any]:
    """
    Return what look.js finds in the page *text*.
    """
    script = LOOK.read_text(encoding="utf-8")
    shown = text.replace("</body>", f"<script>{script}</script></body>")
    dumped = chromium(folder, shown, "--dump-dom", *options)
    match = re.search(r'<pre id="found">(.*?)</pre>', dumped, re.DOTALL)
    assert match
    found: dict[str, Any] = json.loads(unescape(match[1]))
    return found
