"""Checksums: what a file held at a checkpoint, to its last bit."""

import hashlib
from pathlib import Path
from typing import Annotated, Self

from pydantic import Field

from run_files.reading import Part, refuse

DIGEST_BYTES = 16
BLOCK = 2**20  # bytes read at a time


class Checksum(Part):
    """The first `size` bytes of a file, by their BLAKE2b digest."""

    size: Annotated[int, Field(ge=0, lt=2**63)]
    digest: Annotated[str, Field(pattern=rf"^[0-9a-f]{{{2 * DIGEST_BYTES}}}$")]

    @classmethod
    def of_text(cls, text: str) -> Self:
        """That of a text."""
        content = text.encode()
        digest = hashlib.blake2b(content, digest_size=DIGEST_BYTES).hexdigest()
        return cls(size=len(content), digest=digest)

    @classmethod
    def of_file(cls, path: Path) -> Self:
        """That of a whole file.

        Raises:
            OSError: when it cannot be read.
        """
        return cls.model_validate(GrowingFile(path).checksum().model_dump())

    def require(self, path: Path, whole: bool) -> None:
        """Refuse a file that does not begin with these bytes, or where `whole` holds more.

        Raises:
            RunDirectoryError: saying what is wrong.
        """
        try:
            size = path.stat().st_size
            if size < self.size or (whole and size > self.size):
                refuse(path, f"{size} bytes; its run left {self.size} at the newest checkpoint")
            if GrowingFile(path).checksum(self.size) != self:
                refuse(path, "damaged: it is not what its run left at the newest checkpoint")
        except FileNotFoundError:
            refuse(path, "missing")
        except OSError as error:
            refuse(path, error.strerror or error)


class GrowingFile:
    """The checksum of a file that only grows: each byte is read once."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._size = 0
        self._hash = hashlib.blake2b(digest_size=DIGEST_BYTES)

    def checksum(self, size: int | None = None) -> Checksum:
        """Of what the file holds now, or of its first bytes.

        Raises:
            OSError: when it cannot be read.
        """
        with self._path.open("rb") as file:
            file.seek(self._size)
            while size is None or self._size < size:
                block = file.read(BLOCK if size is None else min(BLOCK, size - self._size))
                if not block:
                    break
                self._hash.update(block)
                self._size += len(block)
        return Checksum(size=self._size, digest=self._hash.hexdigest())
