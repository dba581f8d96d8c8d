# Checks scenes against a JSON Schema with an independent validator (Debian: python3-jsonschema, python3-yaml).
#   validate.py SCHEMA accepts|rejects SCENE...
# Exits 0 when the schema is valid draft-07 and accepts, or rejects, every one of the scenes.
import json
import re
import sys

import jsonschema
import yaml


class CoreLoader(yaml.SafeLoader):
    """YAML 1.2 core schema, as the reader of scenes and editors take plain words: `yes` is a text, `1e-5` a number."""

    yaml_implicit_resolvers = {}


def rule(tag, pattern, first):
    CoreLoader.add_implicit_resolver("tag:yaml.org,2002:" + tag, re.compile("^(?:" + pattern + ")$"), first)


rule("null", r"~|null||", ["~", "n", ""])
rule("bool", r"true|false", ["t", "f"])
rule("int", r"[-+]?[0-9]+", list("-+0123456789"))
rule("float", r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.nan", list("-+.0123456789"))
CoreLoader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))


def text_keys(value):
    """Keys are texts, in JSON as in scenes."""
    if isinstance(value, dict):
        return {str(key): text_keys(entry) for key, entry in value.items()}
    return [text_keys(entry) for entry in value] if isinstance(value, list) else value


def main():
    schema_file, wanted, scenes = sys.argv[1], sys.argv[2], sys.argv[3:]
    with open(schema_file, encoding="utf-8") as stream:
        schema = json.load(stream)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    wrong = 0 if scenes else 1
    for scene in scenes:
        with open(scene, encoding="utf-8") as stream:
            content = text_keys(yaml.load(stream, CoreLoader))
        error = jsonschema.exceptions.best_match(validator.iter_errors(content))
        if (error is None) != (wanted == "accepts"):
            wrong += 1
            print(scene + ": " + ("accepted" if error is None else "/".join(map(str, error.absolute_path)) + ": " + error.message[:300]))
    print(f"{len(scenes) - wrong} of {len(scenes)} scenes are {wanted[:-1]}ed as they should be")
    return 1 if wrong else 0


sys.exit(main())
