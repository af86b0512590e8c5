"""The force laws, one function each, made of Weft's own table: names, units, defaults and errors are the same as in scene files.

    weft.laws.tension(stiffness=2000.0)
"""
import inspect
from dataclasses import dataclass, field
from numbers import Real

from weft import _core
from weft.errors import InvalidArgument


@dataclass(frozen=True)
class Law:
    """A law with its parameters in SI units, and the sets of the mesh that it acts on (none: all of the mesh)."""

    name: str
    parameters: dict = field(default_factory=dict)
    sets: tuple = ()

    def __repr__(self):
        values = [f"{name}={value!r}" for name, value in self.parameters.items()]
        values += [f"sets={list(self.sets)!r}"] if self.sets else []
        return f"weft.laws.{self.name}({', '.join(values)})"


def _numbers(law, name, value):
    values = [value] if isinstance(value, Real) else value
    try:
        return [float(one) for one in values]
    except (TypeError, ValueError):
        raise InvalidArgument(f"{law}: {name} = {value!r}, expected a number or three of them") from None


def _tuple_of(law):
    """What the extension modules take."""
    return law.name, list(law.sets), {name: _numbers(law.name, name, value) for name, value in law.parameters.items()}


def _law_of(row):
    name, sets, parameters = row
    return Law(name, {key: values[0] if len(values) == 1 else tuple(values) for key, values in parameters.items()}, tuple(sets))


def laws_from(given):
    """A list of Law from what a caller may write: laws, or a dict of names and parameters ("sets" names the sets)."""
    if isinstance(given, Law):
        given = [given]
    if isinstance(given, dict):
        given = [_law_from_dict(name, parameters) for name, parameters in given.items()]
    laws = list(given)
    for law in laws:
        if not isinstance(law, Law):
            raise InvalidArgument(f"laws: {law!r} is no law, expected weft.laws.NAME(...) or a dict {{name: {{parameter: value}}}}")
    # Checked here, so that the error comes before anything is built.
    _core.checked_laws([_tuple_of(law) for law in laws])
    return laws


def _law_from_dict(name, parameters):
    if not isinstance(parameters, dict):
        raise InvalidArgument(f"laws: {name} = {parameters!r}, expected a dict {{parameter: value}}")
    parameters = dict(parameters)
    sets = parameters.pop("sets", ())
    return Law(name, parameters, (sets,) if isinstance(sets, str) else tuple(sets))


def _make(row):
    """The function of one row of the table, with a signature that editors and help() show."""
    names = [parameter["name"] for parameter in row["parameters"]]
    takes_sets = bool(row["set_key"])

    def law(**given):
        sets = given.pop("sets", ()) if takes_sets else ()
        made = Law(row["name"], given, (sets,) if isinstance(sets, str) else tuple(sets))
        _core.checked_laws([_tuple_of(made)])
        return made

    keywords = [inspect.Parameter(parameter["name"], inspect.Parameter.KEYWORD_ONLY,
                                  default=inspect.Parameter.empty if parameter["required"] else
                                  parameter["default"] if parameter["size"] == 1 else (parameter["default"],) * parameter["size"])
                for parameter in row["parameters"]]
    if takes_sets:
        keywords.append(inspect.Parameter("sets", inspect.Parameter.KEYWORD_ONLY, default=()))
    law.__name__ = law.__qualname__ = row["name"]
    law.__signature__ = inspect.Signature(keywords, return_annotation=Law)
    lines = [row["summary"], "", row["formula"], ""]
    lines += [f"{parameter['name']} [{parameter['unit']}]: {parameter['summary']}" for parameter in row["parameters"]]
    if takes_sets:
        lines.append(f"sets: {row['set_key'].replace('_', ' ')} of the mesh; none: all")
    law.__doc__ = "\n".join(lines)
    assert "sets" not in names
    return law


NAMES = tuple(row["name"] for row in _core.law_table())
for _row in _core.law_table():
    globals()[_row["name"]] = _make(_row)

__all__ = ["Law", "NAMES", *NAMES]
