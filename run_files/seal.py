"""The digest that a JSON file of ours holds of its own content; one written by hand has none."""

import hashlib
import json
from typing import Any

DIGEST = "digest"
BYTES = 16


def digest_of(content: object) -> str:
    """BLAKE2b of some JSON content, whatever the order of its keys."""
    text = json.dumps(content, sort_keys=True)
    return hashlib.blake2b(text.encode(), digest_size=BYTES).hexdigest()


def sealed(content: dict[str, Any]) -> dict[str, Any]:
    """The content with its digest."""
    return content | {DIGEST: digest_of(json.loads(json.dumps(content)))}
