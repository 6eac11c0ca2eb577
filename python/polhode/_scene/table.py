"""Tables of bodies of an ensemble, CSV and Parquet, as text for the core."""

from __future__ import annotations

import hashlib
import io
import os
from pathlib import Path
from typing import Any

from polhode._support.extras import optional
from polhode._support.files import contents


class TableReader:
    """Reads the table that a scene names, and keeps the SHA-256 of its content."""

    def __init__(self) -> None:
        self.sha256: str | None = None

    def read(self, path: str | os.PathLike[str]) -> str:
        """Return a table as comma-separated text with a header line.

        Raises
        ------
        ValueError
            With a message for the scene: the file is missing, cannot be read, or has another format.
        ImportError
            Without the library for Parquet, ``pip install 'polhode[parquet]'``.
        """
        file = Path(path)
        try:
            content = _parquet(file) if file.suffix.lower() == ".parquet" else _csv(file)
            text = content.decode("utf-8-sig")
        except FileNotFoundError:
            raise ValueError(f"{file}: no such file") from None
        except UnicodeDecodeError:
            raise ValueError(f"{file}: not UTF-8 text, save the file as UTF-8") from None
        except OSError as error:
            raise ValueError(f"{file}: cannot be read: {error}") from None
        self.sha256 = hashlib.sha256(content).hexdigest()
        return text


def _csv(file: Path) -> bytes:
    if file.suffix.lower() != ".csv":
        raise ValueError(f"{file}: expected a table in a file .csv or .parquet")
    return contents(file)


def _parquet(file: Path) -> bytes:
    """Return the table of a Parquet file as CSV, in which floats keep all digits."""
    what = "a table of bodies in Parquet"
    library: Any = optional("pyarrow", "parquet", what)
    reader: Any = optional("pyarrow.parquet", "parquet", what)
    csv: Any = optional("pyarrow.csv", "parquet", what)
    content = io.BytesIO(contents(file))
    text = io.BytesIO()
    try:
        table = reader.read_table(content)
        for name, column in zip(table.column_names, table.columns, strict=True):
            # As text a row of nulls alone is a blank line.
            if column.null_count:
                row = column.is_null().index(True).as_py()
                raise ValueError(f"{file}, row {row} (from 0), column `{name}`: the cell is empty")
        csv.write_csv(table, text)
    except library.lib.ArrowException as error:
        raise ValueError(f"{file}: not a table of numbers and strings: {error}") from None
    return text.getvalue()
