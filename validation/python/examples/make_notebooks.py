"""Writes the notebooks beside the scripts, with their outputs: python3 make_notebooks.py [NAME …].

A script has cells that begin with "# %%" or, of text, "# %% [markdown]". Needs python3-nbformat, python3-nbclient and
python3-ipykernel, and the package deflect on PYTHONPATH. Files that cells write go to a folder that is removed.
"""

import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def scripts() -> list:
    return sorted(f for f in HERE.glob("*.py") if f.name != pathlib.Path(__file__).name)


def cells_of(script: pathlib.Path) -> list:
    """[("markdown" or "code", source)]."""
    cells = []
    for part in script.read_text(encoding="utf-8").split("# %%")[1:]:
        first, _, rest = part.partition("\n")
        if "[markdown]" in first:
            lines = [line[2:] if line.startswith("# ") else "" for line in rest.strip().splitlines()]
            cells.append(("markdown", "\n".join(lines)))
        else:
            cells.append(("code", rest.strip()))
    return cells


def write(script: pathlib.Path) -> None:
    import nbclient
    import nbformat

    notebook = nbformat.v4.new_notebook()
    for number, (kind, source) in enumerate(cells_of(script)):
        cell = nbformat.v4.new_markdown_cell(source) if kind == "markdown" else nbformat.v4.new_code_cell(source)
        cell.id = f"{script.stem}-{number}"
        notebook.cells.append(cell)
    with tempfile.TemporaryDirectory() as folder:
        nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", record_timing=False,
                                resources={"metadata": {"path": folder}}).execute()
    notebook.metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    nbformat.write(notebook, script.with_suffix(".ipynb"))
    print(f"{script.stem}.ipynb: {script.with_suffix('.ipynb').stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    for each in scripts():
        if len(sys.argv) == 1 or each.stem in sys.argv[1:]:
            write(each)
