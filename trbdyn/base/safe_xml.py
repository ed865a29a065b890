"""XML of strangers: no document types, so no entities that grow or lead to other files, and limits of depth and number."""

from __future__ import annotations

from typing import Any, Final
from xml.etree import ElementTree
from xml.parsers import expat

from trbdyn.base.reading import read_input
from trbdyn.errors import FileError

DEEPEST: Final = 40
MOST_ELEMENTS: Final = 100_000


class _Refused(Exception):
    """What makes a file unusable, in words."""


def read_xml(path: object) -> ElementTree.Element:
    """The root of an XML file; a FileError if it cannot be read or used."""
    data = read_input(path, "XML")
    depth = count = 0

    def begins(name: str, attributes: Any) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > DEEPEST or count > MOST_ELEMENTS:
            raise _Refused(f"it has more than {MOST_ELEMENTS} elements, or is nested deeper than {DEEPEST}")

    def ends(name: str) -> None:
        nonlocal depth
        depth -= 1

    def has_type(*given: Any) -> None:
        raise _Refused("it has a document type, which is not read")

    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = begins, ends
    parser.StartDoctypeDeclHandler = has_type
    try:
        parser.Parse(data, True)
        return ElementTree.fromstring(data)
    except _Refused as error:
        raise FileError(f"{path}: is no XML file that can be used: {error}") from None
    except (expat.ExpatError, ElementTree.ParseError, ValueError, LookupError) as error:
        raise FileError(f"{path}: is no XML file: {error}") from None


def xml_text(root: ElementTree.Element) -> bytes:
    """An XML file of a root."""
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
