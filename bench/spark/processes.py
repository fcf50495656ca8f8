"""Processes of the session: which are executors, their memory, and the processor time of all."""

import os
from pathlib import Path

TICKS_OF_SECOND = os.sysconf("SC_CLK_TCK")


def executors() -> list[int]:
    """The processes of the executors that this process started."""
    found = []
    for pid in below(os.getpid(), children()):
        try:
            words = Path(f"/proc/{pid}/cmdline").read_bytes()
        except OSError:
            continue
        if b"CoarseGrainedExecutorBackend" in words:
            found.append(pid)
    return found


def children() -> dict[int, list[int]]:
    """The children of each process."""
    found: dict[int, list[int]] = {}
    for path in Path("/proc").iterdir():
        if path.name.isdigit():
            try:
                parent = int((path / "stat").read_text().rpartition(")")[2].split()[1])
            except (OSError, IndexError):
                continue
            found.setdefault(parent, []).append(int(path.name))
    return found


def below(root: int, listed: dict[int, list[int]]) -> list[int]:
    """All processes that one started, and those that these did."""
    here = listed.get(root, [])
    return here + [pid for child in here for pid in below(child, listed)]


def memory_of(pid: int) -> tuple[int, int]:
    """Bytes of a process that are resident, pages that it shares counted by their share; and of these what is not a file."""
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    except OSError:
        return 0, 0
    sizes = {name: 1024 * int(rest.split()[0]) for name, _, rest in (line.partition(":") for line in text.splitlines()[1:])}
    return sizes.get("Pss", 0), sizes.get("Pss_Anon", 0)


def seconds() -> float:
    """The processor time so far of this process and of all that it started, also of those that ended and were waited for."""
    ticks = 0
    for pid in [os.getpid(), *below(os.getpid(), children())]:
        try:
            fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        ticks += sum(map(int, fields[11:15]))
    return ticks / TICKS_OF_SECOND
