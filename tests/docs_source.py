"""docs_source.py FOLDER: writes into FOLDER what Doxygen reads of cambium, for tests/docs: the headers, each as a part of its
room, with the sentence of its parameter at each field; and a page a room, of its README.

docs_source.py --check FILE: of Doxygen's warnings in FILE, those that somebody has to mend."""

import os
import re
import sys

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
include = os.path.join(root, "include", "cambium")
rooms = sorted(r for r in os.listdir(include) if os.path.isfile(os.path.join(include, r, "README.md")))
PAGES = {os.path.join(include, room, "README.md"): f"@defgroup {room}" for room in rooms} | {
    os.path.join(root, "README.md"): "@mainpage",
    os.path.join(include, "README.md"): "@page headers",
    os.path.join(root, "examples", "embed_in_planner", "into_your_stack.md"): "@page into_your_stack",
    os.path.join(root, "examples", "embed_in_planner", "coming_from_bark.md"): "@page coming_from_bark",
    os.path.join(root, ".github", "CONTRIBUTING.md"): "@page contributing",
    os.path.join(root, "maps", "README.md"): "@page maps",
    os.path.join(root, "examples", "README.md"): "@page examples",
    os.path.join(root, "bench", "README.md"): "@page bench",
    os.path.join(root, "tests", "README.md"): "@page tests",
}

PARAMETER = re.compile(r'parameter\(\s*"[^"]*",\s*&(?P<owner>\w+)::(?P<field>\w+)(?P<rest>.*?)(?P<sentence>(?:"[^"]*"\s*)+)\)', re.S)
STRUCT = re.compile(r"^(?:struct|class) (\w+)[^;{]*{\n(.*?)^};", re.S | re.M)
FIELD = re.compile(r"  [\w:<>, ]+ (\w+)(?: = [^;]*|{[^;]*})?;")
SHARED = re.compile(r"\bauto (\w+_parameters)\(")  # makes the parameters of several structs
DETAIL = re.compile(r"^namespace (?:cambium::)?(?:\w+::)?detail {\n.*?^}  // namespace .*\n", re.S | re.M)
NAMESPACE = re.compile(r"(?:\n((?:///.*\n)+))?^namespace ([\w:]+) {\n(\n?)|^}  // namespace .*\n", re.M)


def sentences(text):
    """(struct or function, field) and what its parameter says."""
    for found in PARAMETER.finditer(text):
        unit = re.search(r'^,\s*"([^"]+)",', found["rest"])
        said = "".join(re.findall(r'"([^"]*)"', found["sentence"]))
        functions = SHARED.findall(text, 0, found.start())
        alias = re.findall(rf"using {found['owner']} = (\w+)", text[: found.start()])[-1:]
        for owner in [*(alias or [found["owner"]]), *functions[-1:]]:
            yield (owner, found["field"]), said + (f" [{unit[1]}]" if unit and unit[1] != "-" else "")


def header(text, room, said):
    text = re.sub(r"cambium::inline v\w+?_\d+", "cambium", text)  # users do not write the version

    def struct(found):
        owners = [found[1], *re.findall(r"\b(\w+_parameters)<", found[2])]
        lines = found[2].split("\n")
        for i, line in enumerate(lines):
            field = FIELD.fullmatch(line)
            if field and not (i and lines[i - 1].lstrip().startswith("///")):
                sentence = next((said[owner, field[1]] for owner in owners if (owner, field[1]) in said), None)
                lines[i] += f"  ///< {sentence}" if sentence else ""
        return found[0].replace(found[2], "\n".join(lines))

    grouped = []  # whether the open namespaces are

    def namespace(found):  # as many lines as before
        if not found[2]:
            return f"/** @}} */ {found[0]}" if grouped.pop() else found[0]
        grouped.append(bool(found[3]) and room in rooms)
        about = f"/// @file\n{found[1]}" if found[1] else ""
        blank = f"  /** @addtogroup {room}\n@{{ */\n" if grouped[-1] else f"\n{found[3]}"
        return f"{about}namespace {found[2]} {{{blank}"

    text = DETAIL.sub(lambda found: "\n" * found[0].count("\n"), text)
    return NAMESPACE.sub(namespace, STRUCT.sub(struct, text))


def slug(title):
    """The anchor that GitHub gives to a title."""
    return re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", "-")


def label_of(path):
    return PAGES[path].split()[1] if " " in PAGES[path] else "index"


def link(readme, label):
    folder = os.path.dirname(readme)

    def rewrite(found):
        text, target = " ".join(found[2].split()), found[3]
        if re.match(r"[a-z]+:", target):
            return found[0]
        path, _, anchor = target.partition("#")
        path = os.path.normpath(os.path.join(folder, path)) if path else None
        if path and os.path.join(path, "README.md") in PAGES:
            path = os.path.join(path, "README.md")
        if path is None or path in PAGES:
            return f'@ref {label if path is None else label_of(path)}{"-" + anchor if anchor else ""} "{text}"'
        if not os.path.exists(path):
            sys.exit(f"{os.path.relpath(readme, root)}: there is no {target}")
        path = os.path.relpath(path, os.path.join(root, "build", "docs", "html"))
        return f'<img src="{path}" alt="{text}"/>' if found[1] else f'<a href="{path}">{text}</a>'

    return rewrite


def page(readme):
    label = label_of(readme)
    with open(readme, encoding="utf-8") as file:
        title, _, body = file.read().partition("\n")
    parts = re.split(r"(^```.*?^```$)", body, flags=re.S | re.M)
    for i in range(0, len(parts), 2):
        parts[i] = re.sub(r"^#(#+) (.*)$", lambda h: f"{h[1]} {h[2].replace('`', '')} {{#{label}-{slug(h[2])}}}", parts[i], flags=re.M)
        parts[i] = re.sub(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)", link(readme, label), parts[i])
        parts[i] = re.sub(r"\*\*(?=\S)(.+?)\*\*", r"<b>\1</b>", parts[i], flags=re.S)  # Doxygen does not end it behind a dot
        # A quotation mark would end code in single backticks.
        parts[i] = re.sub(r"`([^`\n]+)`", lambda c: f"``{c[1]}``" if "'" in c[1] else c[0], parts[i])
    body = "".join(parts).replace("/*", "/&zwj;*").replace("*/", "*&zwj;/")
    return f"/** {PAGES[readme]} {title.lstrip('# ')}\n{body}\n*/\n"


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


# What a concept, a base class or the template of a specialisation asks for is described there.
DESCRIBED = re.compile(
    r"Member (operator|(parameters|check|plan|observe|sees|sees_object|steps_back|update|select|roll_out|execute|derivative|limited|"
    r"input|at_goal|drive|heed|look|acceleration|at|foresee|entry|assume|fell_short)\()|of class cambium::(HumanView|map::MapQueries|TrafficDomain|HypothesisDomain) |"
    r"(Member|Compound|struct) [^ ]*<.*>|Compound .*::(Memory|Workspace|State|Input|Statistics) |Member \w+\(\w+ &&\)"
)
ACCESSOR = re.compile(r"Member \w+\(\)(?: const)?(?: noexcept)? \(function\)")
FIELD_OR_TYPE = re.compile(r"Member [^(]* \((variable|typedef|enumeration)\) of (struct|class) |\(friend\) of ")


def to_mend(warnings):
    """All but undocumented members whose names say it (fields, accessors), that are described elsewhere, or that follow in one
    paragraph what is described."""
    for warning in warnings:
        found = re.match(r"(.*?):(\d+): warning: (Member|Compound) .* is not documented", warning)
        if found and (DESCRIBED.search(warning) or ACCESSOR.search(warning) or FIELD_OR_TYPE.search(warning)):
            continue
        if found:
            with open(found[1], encoding="utf-8") as file:
                above = file.read().split("\n")[: int(found[2]) - 1]
            while above and above[-1].strip() and not above[-1].strip().startswith("///") and not above[-1].endswith(":"):
                above.pop()
            if above and above[-1].strip().startswith("///"):
                continue
        yield warning


def main(out):
    for readme in PAGES:
        write(os.path.join(out, f"{label_of(readme)}.dox"), page(readme))
    texts, said = {}, {}
    for folder, _, files in os.walk(include):
        for name in files:
            path = os.path.relpath(os.path.join(folder, name), include)
            if name.endswith(".hpp") and not name.endswith("_impl.hpp") and "detail" not in path.split(os.sep):
                with open(os.path.join(include, path), encoding="utf-8") as file:
                    texts[path] = file.read()
    for text in texts.values():
        said.update(sentences(text))
    for path, text in texts.items():
        write(os.path.join(out, "cambium", path), header(text, path.split(os.sep)[0].removesuffix(".hpp"), said))


if sys.argv[1] == "--check":
    with open(sys.argv[2], encoding="utf-8") as listed:
        sys.stdout.writelines(to_mend(listed))
else:
    main(sys.argv[1])
