"""What runs in a worker process of this machine: it does one task after another; see `hersey.scale.local`.

Tasks and results are pickles: both ends are this package, and nobody else holds an end of the pipes. An
untrusted file is read in a sandboxed process of the worker's own.
"""

from __future__ import annotations

import pickle
import warnings
from typing import Any


def answer(_request: dict[str, Any], payload: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the result of a task, what it raised, and its warnings."""
    result, raised = None, None
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("default")
        try:
            task, item = pickle.loads(payload)
            result = task(item)
        except Exception as error:
            raised = error
    return {}, _packed(result, raised, [each.message for each in heard])


def _packed(result: Any, raised: Exception | None, heard: list[Any]) -> bytes:
    try:
        if raised is not None:
            pickle.loads(pickle.dumps(raised))  # an exception of a library may not travel
    except Exception:
        raised = RuntimeError(f"{type(raised).__name__}: {raised}")
    return pickle.dumps((result, raised, heard))
