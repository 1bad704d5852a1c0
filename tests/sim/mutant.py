"""
Bugs that are planted in templates, to see that a check of verification catches each.
"""

import shutil
from dataclasses import dataclass
from pathlib import Path

from stepgen.library.render import template_dir


@dataclass(frozen=True)
class Mutant:
    """
    A bug: one text of one template replaced by another, the spec that shows it, and what must.

    Args:
        name: What is wrong.
        template: The file under ``templates/``.
        old: What stands there.
        new: What is planted instead.
        check: The check of `stepgen verify` that must catch it, or HAZARDS.
        finding: What that check must say among other things.
        spec: The spec whose library has the bug.
    """

    name: str
    template: str
    old: str
    new: str
    check: str
    finding: str
    spec: str = "uno_motor_shield"

    def plant(self, folder: Path) -> Path:
        """
        Return a copy of the templates in *folder*, with the bug.
        """
        templates = folder / "templates"
        shutil.copytree(template_dir(), templates)
        file = templates / self.template
        text = file.read_text(encoding="utf-8")
        assert text.count(self.old) == 1, self.name
        file.write_text(text.replace(self.old, self.new), encoding="utf-8")
        return templates
