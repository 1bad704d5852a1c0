"""
``python -m stepgen`` is the same as ``stepgen``.
"""

from stepgen.cli import main

if __name__ == "__main__":
    main()
