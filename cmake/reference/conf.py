"""Sphinx: the pages of the repository, the headers by Breathe, the Python package by autodoc. See cmake/make_reference.sh."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pcl_symmetry
from docutils.nodes import SkipNode
from docutils.utils.math.latex2mathml import tex2mathml

FOLDER = Path(__file__).absolute().parent
XML = FOLDER.parent / "xml"

project = "pcl_symmetry"
extensions = ["breathe", "myst_parser", "sphinx.ext.autodoc"]
include_patterns = ["*.rst", "cpp/**", "*.md", "src/pages/**", "apps/README.md", "apps/gallery/README.md"]
include_patterns += ["test/benchmark/*.md"]
html_theme = "furo"
html_title = project
html_copy_source = html_show_copyright = False
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
breathe_projects = {project: str(XML)}
breathe_default_project = project
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"


MEMBERS = list(ElementTree.parse(XML / "namespacepcl__symmetry.xml").iter("memberdef"))


def write_page(header: Path) -> None:
    """A page with what a public header declares, the class of its name first."""
    root = ElementTree.parse(header).getroot().find("compounddef")
    path = Path(root.find("location").get("file"))
    title = path.stem.replace("_", "").lower()
    classes = [each for each in root.findall("innerclass") if each.text.count("::") == 1 and "<" not in each.text]
    members = [member for member in MEMBERS if member.find("location").get("file") == str(path)]
    names = [each.text.split("::")[1] for each in classes] + [m.findtext("name") for m in members]
    if not names:
        return
    title = next((name for name in names if name.lower() == title), names[0] if len(set(names)) == 1 else path.name)
    lines = []
    for each in sorted(classes, key=lambda each: each.text.split("::")[1] != title):
        kind = "class" if each.get("refid").startswith("class") else "struct"
        lines += [f".. doxygen{kind}:: {each.text}", "   :members:", "   :protected-members:", ""]
    for member in members:
        arguments = member.findtext("argsstring") if member.get("kind") == "function" else ""
        lines += [f".. doxygen{member.get('kind')}:: pcl_symmetry::{member.findtext('name')}{arguments}", ""]
    page = (FOLDER / "cpp" / path.relative_to("pcl_symmetry")).with_suffix(".rst")
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text("\n".join([title, "=" * len(title), "", f"``#include <{path}>``", "", *lines]))


for found in XML.glob("*_8h*.xml"):
    write_page(found)


def as_rst(app, what, name, thing, options, lines):
    """Docstrings are plain text: a paragraph begins after an empty line and with the name of a parameter."""
    paragraphs, code = [[]], []
    for line in lines[: lines.index("Fields:") if "Fields:" in lines else None]:  # they stand below, each with its type
        row = re.match(r"(\w+\(\)|[A-Z]\w+)  +(.*)", line)
        if line.startswith((">>>", "[")) and what == "module":
            code.append(line)
            continue
        if row:
            line = f"{row[1]}: {row[2]}"
        if not line.strip() or row or re.match(r"(Returns|Raises)\b|[a-z]\w*(, [a-z]\w*)*: ", line):
            paragraphs.append([])
        line = re.sub(r"([\\\\*`|]|_(?!\w))", r"\\\1", line.strip())
        line = re.sub(r"\b(\w+)\(\)", lambda f: f":func:`~pcl_symmetry.{f[1]}`" if f[1] in pcl_symmetry.__all__ else f[0], line)
        paragraphs[-1].append(line)
    text = [re.sub(r"^([a-z]\w*(, [a-z]\w*)*): ", r"**\1**: ", " ".join(filter(None, each))) for each in paragraphs]
    lines[:] = [line for each in text if each for line in (each, "")]
    lines[2:2] = [*code, ""]


def mathml(is_inline: bool):
    def visit(translator, node):
        formula = tex2mathml(node.astext(), inline=is_inline)
        translator.body.append(formula if is_inline else f'<div style="padding: 0.3em 0">{formula}</div>')
        raise SkipNode

    return visit, None


def setup(app):
    """Formulas are MathML, which browsers typeset without a program and without network."""
    app.connect("autodoc-process-docstring", as_rst)
    app.add_html_math_renderer("mathml", mathml(True), mathml(False))
