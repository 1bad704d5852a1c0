"""
``stepgen schema``: what editors need to complete a spec.
"""

import json

from stepgen import api
from stepgen.commands.report import say

EXAMPLE = "Example: stepgen schema > stepgen.schema.json"


def schema() -> None:
    """
    Print the JSON Schema of a spec; an editor completes and checks with it what is typed.

    For editors with the YAML language server (VS Code's YAML extension, Neovim, Emacs ...) write
    it to a file and begin the spec with: # yaml-language-server: $schema=stepgen.schema.json
    """
    say(json.dumps(api.schema(), indent=2, ensure_ascii=False))
