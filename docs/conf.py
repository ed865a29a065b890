"""How the documentation site is built: MyST pages, code cells executed at build, warnings are errors (`make docs`)."""

import hashlib
import logging
import os
import sys
import tempfile
from pathlib import Path

import numpy as np

import trbdyn

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"  # pictures of code cells stand on the page

# The kernels run on this machine alone: their words about encryption, and the name of each, are no warnings of the site.
_profile = Path(tempfile.mkdtemp(prefix="trbdyn-docs-")) / "profile_default"
_profile.mkdir()
(_profile / "ipython_kernel_config.py").write_text('c.IPKernelApp.log_level = "ERROR"\n')
os.environ["IPYTHONDIR"] = str(_profile.parent)
logging.getLogger("traitlets").setLevel(logging.WARNING)

project = "trbdyn"
author = "The trbdyn developers"
project_copyright = "The trbdyn developers, BSD-3-Clause"
version = release = trbdyn.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # puts MathJax into the site: equations are shown without a network
    "shown_pictures",
]
if not tags.has("check"):  # noqa: F821  (Sphinx gives it)
    extensions.append("sphinx.ext.viewcode")  # a page of each source
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "extensions", "static"]

# A page is run once, and its outputs are kept as long as its cells, the package and its core are the same.
_package = Path(trbdyn.__file__).parent
_inputs = hashlib.sha256()
for _file in sorted(entry for entry in _package.rglob("*") if entry.is_file() and entry.suffix not in (".pyc", ".so")):
    _inputs.update(str(_file.relative_to(_package)).encode() + b"\0" + _file.read_bytes())
_inputs.update(Path(trbdyn._core.__file__).read_bytes() + np.__version__.encode())
nb_execution_mode = "cache"
nb_execution_cache_path = str(Path(__file__).parents[1] / "build" / "docs-cells" / _inputs.hexdigest()[:16])
nb_execution_raise_on_error = True
nb_execution_timeout = 600
nb_execution_show_tb = True
nb_merge_streams = True
nb_render_markdown_format = "myst"  # tables that cells write
nb_execution_in_temp = True
suppress_warnings = ["ref.python"]  # a word of a docstring that many classes have as a field

napoleon_google_docstring = False
napoleon_use_ivar = True
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_default_options = {"members": True, "undoc-members": False, "exclude-members": "model_config"}
autodoc_mock_imports = ["dask", "distributed"]
default_role = "literal"

html_theme = "furo"
html_title = f"trbdyn {version}"
html_show_sphinx = False
html_static_path = ["static"]
html_css_files = ["widths.css"]
html_search_scorer = str(Path(__file__).resolve().parent / "static" / "scorer.js")


def setup(app):
    """Several processes read pages; the extension for formulas only adds a script, and does not say that this is safe."""
    app.extensions["sphinx-mathjax-offline"].parallel_read_safe = True
