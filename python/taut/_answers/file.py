"""What is proved of a file."""

from __future__ import annotations

from .._record import Record, record


@record("items", "compared")
class FileVerdict(Record):
    """What was proved of a file.

    Attributes
    ----------
    items : int
        Records, elements or numbers that were read, in each of the files.
    compared : bool
        Whether the file that was read was compared, or the certificate's word taken for it.
    """

    items: int
    compared: bool
