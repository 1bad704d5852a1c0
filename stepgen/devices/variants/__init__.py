"""
Pin maps that several boards share, named like the Arduino core's folders in ``variants``.
"""
