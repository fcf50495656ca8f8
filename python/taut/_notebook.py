"""What a notebook shows."""

from __future__ import annotations

from html import escape
from typing import Any

from ._record import brief


def page(title: str, facts: list[tuple[str, Any]], picture: str | None) -> str:
    """A table of facts, below a picture in SVG if there is one."""
    rows = "".join(
        f'<tr><th scope="row" style="text-align: left">{escape(name.replace("_", " "))}</th>'
        f'<td style="text-align: left">{escape(fact if isinstance(fact, str) else brief(fact))}</td></tr>'
        for name, fact in facts
    )
    return f"<div>{picture or ''}<table><caption>{escape(title)}</caption><tbody>{rows}</tbody></table></div>"
