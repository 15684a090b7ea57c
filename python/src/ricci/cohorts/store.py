"""Rows of a cohort on disk: a small Parquet file for each finished mesh, and one table at the end."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from ricci._library import VERSION
from ricci.cohorts.fingerprint import changed
from ricci.cohorts.jobs import Row, failed
from ricci.errors import ArgumentError

# Columns that every row has, in this order before all others; those of results and of reports.
HEAD = {
    "path": pa.string(),
    "content": pa.string(),
    "ok": pa.bool_(),
    "error": pa.string(),
    "status": pa.string(),
    "element": pa.string(),
    "index": pa.int64(),
    "amount": pa.float64(),
    "message": pa.string(),
    "worker": pa.int64(),
    "seconds": pa.float64(),
}
KINDS = ("results", "reports")


def _write(table: pa.Table, path: Path) -> None:
    """Writes a file that appears whole or not at all."""
    part = path.with_suffix(".part")
    pq.write_table(table, part)
    os.replace(part, path)


def _read(path: Path) -> pa.Table:
    """Reads a whole file. `read_table` searches folders of files, which takes longer than reading one row."""
    with pq.ParquetFile(path) as file:
        return file.read()


class Store:
    """The folder of a cohort: `results.parquet`, `reports.parquet`, and in `rows` the meshes that were done since these were written.

    Raises
    ------
    ArgumentError
        the folder has rows of another job.
    """

    def __init__(self, folder: Path, job: str) -> None:
        self.folder, self.rows = folder, folder / "rows"
        self.rows.mkdir(parents=True, exist_ok=True)
        note, own = folder / "job.json", f"{job}, ricci {VERSION}"
        if note.exists() and (any(self.rows.iterdir()) or (folder / "results.parquet").exists()):
            known = json.loads(note.read_text(encoding="utf-8"))["job"]
            if known != own:
                why = changed(known, own)
                because = f" ({why})" if why else ""
                raise ArgumentError(
                    f"{folder} has the rows of another job{because}: {known}, not {own}. Name another folder, or delete this one"
                )
        else:
            note.write_text(json.dumps({"job": own}), encoding="utf-8")

    def _place(self, kind: str, path: str) -> Path:
        return self.rows / f"{hashlib.sha256(path.encode()).hexdigest()[:32]}.{kind}"

    def add(self, row: Row) -> None:
        """Keep one row. The result is written last: a row without it is not done. A value that Parquet cannot hold is that row's error."""
        try:
            report, result = _table([row.report]), _table([row.result])
        except pa.ArrowException as wrong:
            row = failed(row.path, wrong, row.result["content"])
            report, result = _table([row.report]), _table([row.result])
        _write(report, self._place("reports", row.path))
        _write(result, self._place("results", row.path))

    def done(self) -> dict[str, tuple[bool, str | None]]:
        """The paths that have a row: whether it is without error, and the content that the file had."""
        table = self._joined("results")
        if not len(table):
            return {}
        # A table without this column is of a time when nobody looked at it.
        contents = table["content"].to_pylist() if "content" in table.column_names else [None] * len(table)
        return dict(zip(table["path"].to_pylist(), zip(table["ok"].to_pylist(), contents, strict=True), strict=True))

    def _joined(self, kind: str) -> pa.Table:
        """The table and the rows beside it. If a path is in both, the row beside the table replaces that of the table."""
        parts = [_read(path) for path in sorted(self.rows.glob(f"*.{kind}"))]
        whole = self.folder / f"{kind}.parquet"
        if whole.exists():
            table = _read(whole)
            newer = {path for part in parts for path in part["path"].to_pylist()}
            parts.insert(0, table.filter(pa.array([path not in newer for path in table["path"].to_pylist()], pa.bool_())))
        return _concatenated(parts)

    def finish(self, paths: Sequence[str]) -> dict[str, pa.Table]:
        """Write both tables, with the given paths in their order, then those of earlier runs; the single rows go."""
        tables = {}
        for kind in KINDS:
            table = self._joined(kind)
            found = {path: at for at, path in enumerate(table["path"].to_pylist())} if len(table) else {}
            order = [found.pop(path) for path in paths if path in found] + list(found.values())
            tables[kind] = _ordered(table.take(pa.array(order, pa.int64())))
            _write(tables[kind], self.folder / f"{kind}.parquet")
        shutil.rmtree(self.rows)
        return tables


def _table(rows: list[dict[str, Any]]) -> pa.Table:
    return pa.Table.from_pylist(rows)


def _concatenated(parts: Iterable[pa.Table]) -> pa.Table:
    """The rows of several tables in one. A column that a table lacks is empty in its rows, and types widen."""
    parts = list(parts)
    return pa.concat_tables(parts, promote_options="permissive") if parts else pa.table({"path": pa.array([], pa.string())})


def _ordered(table: pa.Table) -> pa.Table:
    """The columns in an order that does not depend on which row came first."""
    names = [name for name in HEAD if name in table.column_names]
    table = table.select(names + sorted(set(table.column_names) - set(names)))
    return table.cast(pa.schema([field.with_type(HEAD.get(field.name, field.type)) for field in table.schema]))
