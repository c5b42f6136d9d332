"""A kind of contract that import-linter lacks: which libraries each layer may import, by name.

import-linter calls these classes; see ``contract_types`` in pyproject.toml.
"""

from __future__ import annotations

import sys
from typing import Any

from grimp import ImportGraph
from importlinter import Contract, ContractCheck, fields, output


class AllowedField(fields.Field):
    """A table from the name of a layer to the list of its libraries."""

    def parse(self, raw_data: Any) -> dict[str, frozenset[str]]:
        """Raises ValidationError where it is anything else."""
        if not isinstance(raw_data, dict):
            raise fields.ValidationError("a table is wanted: layer = [library, ...]")
        of_strings = fields.SetField(subfield=fields.StringField())
        return {layer: frozenset(of_strings.parse(libraries)) for layer, libraries in raw_data.items()}


class LibrariesContract(Contract):
    """Each layer imports the libraries ``allowed`` to it and no other; one that is not named there imports none.

    A permission that nothing uses breaks the contract too, so that the list says what is so.  The standard library is
    free to all.
    """

    allowed = AllowedField()

    def check(self, graph: ImportGraph, verbose: bool) -> ContractCheck:
        """Every direct import of a library from every module of the package."""
        (root,) = self.session_options["root_packages"]
        allowed: dict[str, frozenset[str]] = self.allowed  # type: ignore[assignment]
        used: dict[str, set[str]] = {}
        forbidden = []
        for importer in sorted(graph.find_descendants(root) | {root}):
            layer = importer.removeprefix(root).split(".")[1] if importer != root else root
            for imported in sorted(graph.find_modules_directly_imported_by(importer)):
                library = imported.split(".")[0]
                if library == root or library in sys.stdlib_module_names:
                    continue
                used.setdefault(layer, set()).add(library)
                if library not in allowed.get(layer, ()):
                    details = graph.get_import_details(importer=importer, imported=imported)
                    lines = ", ".join(str(detail["line_number"]) for detail in details)
                    forbidden.append(f"{importer} imports {library} (l.{lines}), which is not allowed to '{layer}'")
        unused = [
            f"'{layer}' is allowed {library}, which nothing in it imports"
            for layer, libraries in allowed.items()
            for library in sorted(libraries - used.get(layer, set()))
        ]
        return ContractCheck(kept=not forbidden + unused, metadata={"faults": forbidden + unused})

    def render_broken_contract(self, check: ContractCheck) -> None:
        """One line an import."""
        for fault in check.metadata["faults"]:
            output.print_error(f"- {fault}", bold=False)
        output.new_line()
