from typing import Any

__version__: str

def __getattr__(name: str) -> Any: ...

class Merging:
    patches: Any
    def __init__(self, *arguments: Any, **more: Any) -> None: ...
    def merges(self, weights: Any = None) -> Any: ...
