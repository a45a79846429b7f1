"""Whether a file's logic is the one that its terms need."""

import re

from .scan import Script

# The logics of SMT-COMP 2026.
LOGICS = frozenset(
    """
    ABV ABVFP ABVFPLRA ALIA ANIA AUFBV AUFBVDTLIA AUFBVDTNIA AUFBVDTNIRA AUFBVFP AUFDTLIA AUFDTLIRA AUFDTNIRA
    AUFFPDTNIRA AUFLIA AUFLIRA AUFNIA AUFNIRA BV BVFP BVFPLRA FP FPLRA LIA LRA NIA NRA QF_ABV QF_ABVFP QF_ABVFPLRA
    QF_ALIA QF_ANIA QF_AUFBV QF_AUFBVFP QF_AUFBVLIA QF_AUFBVNIA QF_AUFLIA QF_AUFNIA QF_AX QF_BV QF_BVFP QF_BVFPLRA
    QF_BVLRA QF_DT QF_FP QF_FPLRA QF_IDL QF_LIA QF_LIRA QF_LRA QF_NIA QF_NIRA QF_NRA QF_RDL QF_S QF_SLIA QF_SNIA
    QF_UF QF_UFBV QF_UFBVDT QF_UFBVLIA QF_UFDT QF_UFDTLIA QF_UFDTLIRA QF_UFDTNIA QF_UFFP QF_UFFPDTNIRA QF_UFIDL
    QF_UFLIA QF_UFLRA QF_UFNIA QF_UFNRA UF UFBV UFBVDT UFBVFP UFBVLIA UFDT UFDTLIA UFDTLIRA UFDTNIA UFDTNIRA
    UFFPDTNIRA UFIDL UFLIA UFLRA UFNIA UFNIRA UFNRA
    """.split()
)

# A logic's name, read from the left.
PARTS = re.compile(
    r"(?P<arrays>AX|A)?(?P<functions>UF)?(?P<bits>BV)?(?P<floats>FP)?(?P<datatypes>DT)?(?P<strings>S)?"
    r"(?P<arithmetic>[LN](?:IA|RA|IRA)|IDL|RDL)?"
)

ARITHMETIC = {
    "": set(), "LIA": {"Int"}, "IDL": {"Int"}, "LRA": {"Real"}, "RDL": {"Real"}, "LIRA": {"Int", "Real"},
    "NIA": {"Int", "nonlinear"}, "NRA": {"Real", "nonlinear"}, "NIRA": {"Int", "Real", "nonlinear"},
}

# What a feature of a logic is called, and the rule that it belongs to.
NAMES = {
    "functions": ("uninterpreted sorts or functions", "logic-functions"),
    "sorts": ("uninterpreted sorts or functions", "logic-functions"), "bits": ("bit-vectors", "logic-bit-vectors"),
    "datatypes": ("datatypes", "logic-datatypes"), "Int": ("integers", "logic-arithmetic"),
    "Real": ("reals", "logic-arithmetic"), "nonlinear": ("nonlinear arithmetic", "logic-arithmetic"),
    "arrays": ("arrays", "logic-others"), "strings": ("strings", "logic-others"),
    "floats": ("floating-point numbers", "logic-others"),
}


def features(logic: str) -> set[str]:
    """What a logic has besides Booleans."""
    match = PARTS.fullmatch(logic.removeprefix("QF_"))
    if match is None:
        return set()
    found = {name for name, text in match.groupdict().items() if text and name != "arithmetic"}
    # Arrays alone are over free sorts.
    if "functions" in found or match["arrays"] == "AX":
        found.add("sorts")
    return found | ARITHMETIC[match["arithmetic"] or ""]


def needed(script: Script, logic: str) -> dict[str, int]:
    """What the terms and declarations of a file need, each with the first place."""
    places = script.features
    need = {}
    for feature, name in [("Int", "Int"), ("Real", "Real"), ("BitVec", "bits"), ("Array", "arrays"),
                          ("String", "strings"), ("FloatingPoint", "floats")]:
        if feature in places:
            need[name] = places[feature]
    if "numeral" in places and not {"Int", "Real"} & need.keys():
        need["Real" if "Real" in features(logic) else "Int"] = places["numeral"]
    for command in script.commands:
        if command.name in ("declare-datatype", "declare-datatypes"):
            need.setdefault("datatypes", command.start)
        elif command.name == "declare-sort":
            need.setdefault("sorts", command.start)
        elif command.name == "declare-fun" and command.tokens[4:5] != [b")"]:
            need.setdefault("functions", command.start)
    # Nothing but Booleans is QF_UF, or UF.
    return need or {"functions": 0}


def judged(script: Script, logic: str) -> list[tuple[int, str, str]]:
    """What is wrong with a file's logic: a place, a rule, and a message each."""
    if logic not in LOGICS:
        return [(0, "logic-known", f"{logic} is no logic of the competition")]
    wrong = []
    quantifier = script.features.get("quantifier")
    free = logic.startswith("QF_")
    if free and quantifier is not None:
        wrong.append((quantifier, "logic-quantifiers", f"a quantifier, and the logic is {logic}"))
    if not free and quantifier is None:
        wrong.append((0, "logic-quantifiers", f"no quantifier, and the logic is {logic}"))
    need, has = needed(script, logic), features(logic)
    for feature in sorted(need.keys() - has):
        name, rule = NAMES[feature]
        if need == {"functions": 0}:
            name = "nothing but Booleans"
        wrong.append((need[feature], rule, f"{name}, and the logic is {logic}"))
    others = [features(other) for other in LOGICS if other.startswith("QF_") == free]
    less = [other for other in others if need.keys() <= other < has]
    if less and need.keys() <= has:
        for feature in sorted(has - min(less, key=lambda other: (len(other), sorted(other)))):
            name, rule = NAMES[feature]
            wrong.append((0, rule, f"no {name}, and the logic is {logic}"))
    # Sorts and functions are of one name.
    return list({message: (place, rule, message) for place, rule, message in reversed(wrong)}.values())[::-1]
