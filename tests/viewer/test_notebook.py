"""The widget in JupyterLab: Python and the page are synchronised."""

import json
import os
import re
import sys
import threading

import pytest

import processes
from missing import left_out

CELLS = (
    "import polhode as ph\nviewer = ph.view('box.toml')\nviewer",
    "print('reported', viewer.state is not None)",
    "viewer.time = 1.25",
    "print('shown', viewer.time, viewer.state.omega_body.components.tolist())",
)
ADDRESS = r"http://127\.0\.0\.1:\d+"
SCENE = """\
[body]
moments = [1, 2, 3]
[initial]
spin = { vector = [0.3, 1, 0.2] }
[run]
duration = "5 s"
"""


@pytest.fixture
def notebook(tmp_path):
    """The address of a notebook with the cells in JupyterLab."""
    try:
        import ipykernel  # noqa: F401
        import jupyterlab  # noqa: F401
    except ImportError:
        left_out("JupyterLab was not found: pip install --group notebook-test")
    (tmp_path / "box.toml").write_text(SCENE)
    cells = [
        {
            "cell_type": "code",
            "id": f"c{k}",
            "execution_count": None,
            "metadata": {},
            "outputs": [],
            "source": text,
        }
        for k, text in enumerate(CELLS)
    ]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    (tmp_path / "a.ipynb").write_text(
        json.dumps({"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5})
    )
    command = [
        *(sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1", "--port=0"),
        *("--IdentityProvider.token=secret", "--LabApp.news_url=", f"--ServerApp.root_dir={tmp_path}"),
        "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
        "--LabApp.expose_app_in_browser=True",
    ]
    folders = {"JUPYTER_CONFIG_DIR": str(tmp_path / "config"), "JUPYTER_DATA_DIR": str(tmp_path / "data")}
    with processes.start(command, stdout=None, env={**os.environ, **folders}) as server:
        address = next(found[0] for line in server.stderr if (found := re.search(ADDRESS, line)))
        # Drain its output, which nothing reads from now on.
        reader = threading.Thread(target=server.stderr.read)
        reader.start()
        yield f"{address}/lab?reset&token=secret"
        # It also ends its kernels.
        server.terminate()
        server.wait()
        reader.join()


@pytest.mark.slow
def test_python_and_the_page_are_synchronised(notebook, pages):
    page = pages()
    lab, viewer = page.page, page.viewer
    lab.context.set_offline(False)
    lab.goto(notebook)
    lab.wait_for_function("window.jupyterapp")
    lab.evaluate(
        """async () => {
            await jupyterapp.restored;
            window.panel = await jupyterapp.commands.execute("docmanager:open", { path: "a.ipynb" });
            await panel.context.ready;
            await panel.sessionContext.ready;
        }"""
    )

    def run(cell):
        """Run a cell to its end."""
        lab.evaluate(
            """cell => {
                panel.content.activeCellIndex = cell;
                return jupyterapp.commands.execute("notebook:run-cell");
            }""",
            cell,
        )

    def run_until(cell, text):
        """Run a cell until it prints a text, and return it. The page reports to Python with a delay."""
        output = lab.locator(".jp-OutputArea-output", has_text=text)
        for _ in range(200):
            run(cell)
            if output.count():
                break
        return output.inner_text()

    run(0)
    viewer.wait_for(timeout=60_000)
    page.settled()
    run_until(1, "reported True")
    run(2)
    page.until("model.time.value === 1.25")
    # Now in the page.
    lab.get_by_label("Time, s").fill("3.5")
    lab.get_by_label("Time, s").press("Enter")
    page.until("model.time.value === 3.5")
    rates = page.data("omega-body").tolist()
    printed = run_until(3, "shown 3.5")
    assert json.loads(printed.partition("3.5 ")[2]) == pytest.approx(rates, abs=1e-15)
    asked = {re.match(r"\w+://[^/]*", address)[0] for address in page.requests}
    assert {re.sub(r":\d+$", "", address) for address in asked} <= {"http://127.0.0.1", "ws://127.0.0.1"}
    lab.context.close()
