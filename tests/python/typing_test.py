# SPDX-License-Identifier: MIT
"""Type stubs and documentation say what is there."""
import ast
import inspect
import unittest
from pathlib import Path

import framewatch
from framewatch import _core

PACKAGE = Path(framewatch.__file__).parent


class Typing(unittest.TestCase):
    def test_the_package_is_typed(self):
        self.assertTrue((PACKAGE / "py.typed").exists())

    def test_the_stub_has_every_name_of_the_extension(self):
        stub = ast.parse((PACKAGE / "_core.pyi").read_text())
        stated, members = set(), {}
        for node in stub.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                stated.add(node.name)
            if isinstance(node, ast.ClassDef):
                members[node.name] = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            if isinstance(node, ast.AnnAssign):
                stated.add(node.target.id)
        self.assertEqual(stated, {name for name in vars(_core) if not name.startswith("__")})
        for name in ("Building", "Estimator"):
            own = {n for n in vars(getattr(_core, name)) if not n.startswith("_")}
            self.assertEqual(members[name] - {"__init__"}, own)

    def test_everything_public_is_documented_and_annotated(self):
        for name in framewatch.__all__:
            thing = getattr(framewatch, name)
            if isinstance(thing, tuple):
                continue
            with self.subTest(name=name):
                self.assertGreater(len(inspect.getdoc(thing) or ""), 20)
                if not inspect.isfunction(thing):
                    continue
                signature = inspect.signature(thing)
                self.assertIsNot(signature.return_annotation, inspect.Signature.empty)
                for parameter in signature.parameters.values():
                    self.assertIsNot(parameter.annotation, inspect.Parameter.empty)
        for method in (framewatch.Estimator.push, framewatch.Estimator.finish,
                       framewatch.Building.from_toml, framewatch.Estimates.to_pandas):
            self.assertGreater(len(inspect.getdoc(method) or ""), 20)

    def test_shapes_are_stated(self):
        self.assertIn("shape (n, channels)", inspect.getdoc(framewatch.Estimator.push))
        self.assertIn("shape (windows, parameters)", inspect.getdoc(framewatch.Estimates))


if __name__ == "__main__":
    unittest.main()
