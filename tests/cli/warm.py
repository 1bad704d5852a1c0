"""
Runs of ``python -m stepgen`` that need not import it anew: a process that has, and forks for each.

A run is a process of its own all the same, with an exit code and two streams.
"""

import json
import os
import runpy
import signal
import sys
from pathlib import Path

import stepgen.cli

TIMEOUT_S = 300
_FLAGS = os.O_WRONLY | os.O_CREAT | os.O_TRUNC


def serve() -> None:
    """
    Make the run that each line of stdin asks for, and print its exit code.
    """
    for line in sys.stdin:
        pid = os.fork()
        if not pid:
            _run(**json.loads(line))
        _, status = os.waitpid(pid, 0)
        sys.stdout.write(f"{os.waitstatus_to_exitcode(status)}\n")
        sys.stdout.flush()


def _run(arguments: list[str], folder: str, environment: dict[str, str]) -> None:
    """
    Be ``python -m stepgen`` with *arguments*, in *folder*, whose parent gets both streams.
    """
    signal.alarm(TIMEOUT_S)
    out = Path(folder)
    for stream, name in enumerate((os.devnull, f"{out}.out", f"{out}.err")):
        os.dup2(os.open(name, _FLAGS if stream else os.O_RDONLY), stream)
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    sys.argv[1:] = arguments
    runpy.run_module(stepgen.__name__, run_name="__main__", alter_sys=True)
    sys.exit()


if __name__ == "__main__":
    serve()
