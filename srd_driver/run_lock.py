"""One process at a time in a run directory: a lock that dies with its process.

The lock is the system's on the file `.lock`, so a kill leaves none behind. A file system without
locks does not stop a run; it only cannot protect it.
"""

import fcntl
import os
import socket
import time as clock
from pathlib import Path
from typing import TextIO

from srd_driver.errors import RunError

LOCK = ".lock"
ATTEMPTS = 10  # `is_locked` holds the lock for a moment
PAUSE_SECONDS = 0.05


def lock(directory: Path) -> TextIO:
    """Keep other processes out of the directory until the file returned is closed.

    Raises:
        RunError: when another process runs there, naming it.
        OSError: when the directory cannot be written.
    """
    file = (directory / LOCK).open("a+", encoding="utf-8")
    for _ in range(ATTEMPTS):
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            break
        except BlockingIOError:
            clock.sleep(PAUSE_SECONDS)
        except OSError:
            break
    else:
        file.seek(0)
        holder = file.read()
        file.close()
        raise RunError(f"{directory} is being run by {holder}")
    file.truncate(0)
    file.write(f"process {os.getpid()} on {socket.gethostname()}")
    file.flush()
    return file


def is_locked(directory: Path) -> bool:
    """Whether a process runs in the directory."""
    try:
        with (directory / LOCK).open(encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False
