"""
How a plan is written out: a view of finished text, Jinja2 that prints it, files that are safe.
"""
