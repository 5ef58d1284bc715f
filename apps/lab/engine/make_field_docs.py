# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Makes doc_of_camera_key() of the comments beside the fields in camera.hpp.

    python3 make_field_docs.py HEADER.. -o field_docs.cpp
"""

import argparse
import json
import re


def structs_of(text):
    """By the name of each struct: its comment, and (type, name, comment) of each member."""
    structs, comment, struct = {}, [], None  # enumerations are structs without members
    for line in text.splitlines():
        stripped = line.strip()
        after = re.match(r"(.*?)\s*///<\s?(.*)", line)
        if struct and after and not after[1].strip() and structs[struct]["members"]:
            structs[struct]["members"][-1][2].append(after[2])  # goes on
            continue
        if stripped.startswith("///"):
            comment.append(stripped[3:].strip())
            continue
        opened = re.match(r"(struct|enum class) (\w+) \{$", line)
        if opened:
            struct = opened[2]
            structs[struct] = {"doc": comment, "members": []}
        elif line.startswith("};"):
            struct = None
        elif struct:
            member = re.match(r"  ([\w:<>, ]+?) ((?:\w+(?: = \{\})?(?:, )?)+)(?: = [^;]*|\{[^;]*\})?;",
                              line)
            if member and "(" not in line.split(";")[0].replace(member[1], ""):
                for name in re.findall(r"\w+", member[2]):
                    structs[struct]["members"].append(
                        (member[1], name, list(comment) + ([after[2]] if after else [])))
        comment = []
    return structs


def docs_of(structs, name, prefix=""):
    """Comments by key, of the fields of a struct and of those within them."""
    docs = {}
    for kind, field, comment in structs[name]["members"]:
        kind = re.sub(r"std::optional<(.*)>", r"\1", kind)
        key = prefix + field
        docs[key] = " ".join(comment or structs.get(kind, {"doc": []})["doc"])
        if kind in structs:
            docs.update(docs_of(structs, kind, key + "."))
    return docs


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("headers", nargs="+")
    arguments.add_argument("-o", required=True)
    arguments = arguments.parse_args()
    structs = {}
    for header in arguments.headers:
        with open(header, encoding="utf-8") as file:
            structs.update(structs_of(file.read()))
    docs = docs_of(structs, "Camera")
    # Keys of a camera file that stand beside each other and are of several structs.
    for key in list(docs):
        if key.startswith("blur."):
            docs["lens." + key[len("blur."):].replace("kind", "blur")] = docs[key]
    docs["lens.distortion_model"] = docs.get("lens.distortion.model", "")
    docs["lens.distortion"] = docs.get("lens.distortion.coefficients", "")
    with open(arguments.o, "w", encoding="utf-8") as file:
        file.write('#include "camera_call.hpp"\n\nnamespace tofsmith::lab {\n\n'
                   "std::string_view doc_of_camera_key(std::string_view key) {\n")
        for key, doc in sorted(docs.items()):
            if doc:
                text = json.dumps(re.sub(r"\s+", " ", doc), ensure_ascii=False)
                file.write(f"  if (key == {json.dumps(key)}) return {text};\n")
        file.write('  return "";\n}\n\n}  // namespace tofsmith::lab\n')


if __name__ == "__main__":
    main()
