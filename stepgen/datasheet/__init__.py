"""
The datasheet: one page about a library, with its wiring drawn and its figures in tables.

A layer of its own above the library's files: it draws and tabulates what the plan decided and what
a verification measured, and it writes HTML, where text is escaped; the other files are C++ and
plain text.
"""
