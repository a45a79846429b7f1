"""SMT-LIB 2 text as commands.

Terms are not kept, only what the rules ask of them, so that a file of 50 MB takes seconds and little more memory than its
text. Nothing recurses: terms may be nested as deeply as they like.
"""

import dataclasses
import re
from collections.abc import Iterator

WORD = rb"[\w~!@$%^&*+=<>.?/-]"
# Reserved words and names of sorts; none may be declared by a file.
KNOWN = rb"""(?:forall|exists|Int|Real|BitVec|Array|String|RegLan|RoundingMode|FloatingPoint|Float(?:16|32|64|128)|par|_)
    (?!WORD)"""
# One alternative for each thing that makes a difference. What is none of them is a character that cannot stand there.
TOKENS = rb"""
    | (?P<known>KNOWN)
    | (?P<symbol>[A-Za-z~!@$%^&*_+=<>.?/-]WORD*+)
    | (?P<decimal>[0-9]++\.[0-9]++(?!WORD))
    | (?P<numeral>(?:0|[1-9][0-9]*+)(?!WORD))
    | (?P<bits>\#(?:b[01]++|x[0-9A-Fa-f]++)(?!WORD))
    | (?P<keyword>:WORD++)
    | (?P<quoted>\|[^|\\]*+\|)
    | (?P<string>"(?:[^"]|"")*+"(?!"))
    | (?P<comment>;[^\r\n]*+)
    | (?P<wrong>[^ \t\r\n])
    )"""


def pattern(text: bytes) -> re.Pattern[bytes]:
    text = text.replace(b"TOKENS", TOKENS).replace(b"KNOWN", KNOWN).replace(b"WORD", WORD)
    return re.compile(text, re.VERBOSE | re.ASCII)


TOKEN = pattern(rb"[ \t\r\n]*+(?: (?P<open>\() | (?P<close>\)) TOKENS")
# In terms: with all the parentheses and symbols at once of which there is nothing to say.
TERM = pattern(
    rb"""(?: (?P<skip>(?:[ \t\r\n]++ | (?!KNOWN)[A-Za-z~!@$%^&*_+=<>.?/-]WORD*+)++)
    | (?P<open>\((?:[ \t\r\n(]++ | (?!KNOWN)[A-Za-z~!@$%^&*_+=<>.?/-]WORD*+)*+)
    | (?P<close>\)(?:[ \t\r\n]*+\))*+) TOKENS"""
)

# Commands of which only the name is kept.
WITH_TERMS = (b"assert", b"define-fun")


@dataclasses.dataclass
class Command:
    """A command: `(name ...)`."""

    start: int
    """Where it begins in the text."""
    end: int = 0
    """Where its last parenthesis is."""
    tokens: list[bytes] = dataclasses.field(default_factory=list)
    """What it is written with, parentheses included; of commands with terms only the name."""

    @property
    def name(self) -> str:
        """The command's name; empty where it has none."""
        return self.tokens[1].decode("ascii", "replace") if len(self.tokens) > 1 else ""

    @property
    def keyword(self) -> str:
        """What an option or a piece of information is about, such as `:status`."""
        has = self.name in ("set-info", "set-option") and len(self.tokens) > 3
        return self.tokens[2].decode("ascii", "replace") if has else ""

    @property
    def value(self) -> bytes:
        """The value of an option or a piece of information, where it is a single token."""
        return self.tokens[3] if self.keyword and len(self.tokens) == 5 else b""

    @property
    def argument(self) -> bytes:
        """The single argument of a command; empty where it has none, or several."""
        return self.tokens[2] if len(self.tokens) == 4 else b""


@dataclasses.dataclass
class Script:
    """A text, read."""

    commands: list[Command] = dataclasses.field(default_factory=list)
    features: dict[str, int] = dataclasses.field(default_factory=dict)
    """What occurs in sorts and terms, with the first place: `quantifier`, `Int`, `BitVec`, `numeral`, `function`..."""
    named: list[tuple[int, bool]] = dataclasses.field(default_factory=list)
    """Each `:named`: its place, and whether what is named is a whole assertion."""
    texts: list[tuple[int, bytes]] = dataclasses.field(default_factory=list)
    """Comments, strings and quoted symbols that have a parenthesis, which could be taken for commands."""
    wrong: tuple[int, str] | None = None
    """The first thing that is no SMT-LIB."""


FEATURES = {
    b"forall": "quantifier", b"exists": "quantifier", b"Int": "Int", b"Real": "Real", b"BitVec": "BitVec",
    b"Array": "Array", b"String": "String", b"RegLan": "String", b"RoundingMode": "FloatingPoint", b"par": "par",
}


class Scanner:
    """Reads a text, command by command."""

    def __init__(self, text: bytes) -> None:
        self.text = text
        self.script = Script()
        self.depth = 0
        # Whether the innermost list began with `_`: its numerals are indices.
        self.index = False

    def run(self) -> Script:
        """Reads the text as far as it is SMT-LIB."""
        place = 0
        while self.script.wrong is None and (match := TOKEN.match(self.text, place)):
            place = match.end()
            if match.lastgroup == "open":
                place = self.command(match.start("open"), place)
            elif match.lastgroup == "close":
                self.wrong(match.start("close"), "a closing parenthesis too many")
            elif match.lastgroup == "comment":
                self.words(match.start("comment"), match["comment"])
            else:
                self.stray(match)
        return self.script

    def command(self, start: int, place: int) -> int:
        """Reads what follows a command's opening parenthesis; gives where it ends."""
        command = Command(start, tokens=[b"("])
        tokens = command.tokens
        self.depth = 1
        while self.depth and (match := TOKEN.match(self.text, place)):
            place = match.end()
            kind = match.lastgroup
            if kind == "comment":
                self.words(match.start(kind), match[kind])
                continue
            if kind == "open":
                self.depth += 1
            elif kind == "close":
                self.depth -= 1
                command.end = match.start(kind)
            elif not self.atom(match, command, False):
                return place
            tokens.append(match[kind])
            if len(tokens) == 2 and tokens[1] in WITH_TERMS:
                place = self.terms(command, place)
        if self.depth:
            self.wrong(start, "this command has no end")
        elif self.script.wrong is None:
            self.script.commands.append(command)
        return place

    def terms(self, command: Command, place: int) -> int:
        """Reads the rest of a command with terms; gives where it ends."""
        while match := TERM.match(self.text, place):
            place = match.end()
            kind = match.lastgroup
            if kind == "open":
                self.depth += match[kind].count(b"(")
            elif kind == "close":
                self.index = False
                closed = match[kind].count(b")")
                if closed >= self.depth:
                    return self.closed(command, match.start(), self.depth)
                self.depth -= closed
            elif kind == "comment":
                self.words(match.start(kind), match[kind])
            elif kind != "skip" and not self.atom(match, command, True):
                return place
        return place

    def closed(self, command: Command, place: int, count: int) -> int:
        """The place after so many closing parentheses, of which the last ends a command."""
        for _ in range(count):
            place = self.text.index(b")", place) + 1
        self.depth, command.end = 0, place - 1
        return place

    def atom(self, match: re.Match[bytes], command: Command, term: bool) -> bool:
        """Notes what there is to say of an atom; whether it is one."""
        kind = match.lastgroup or "wrong"
        place = match.start(kind)
        features = self.script.features
        if kind == "wrong":
            self.stray(match)
            return False
        if kind == "known" and match[kind] == b"_":
            self.index = True
        elif kind == "known":
            features.setdefault(FEATURES.get(match[kind], "FloatingPoint"), place)
        elif kind == "numeral" and term and not self.index:
            features.setdefault("numeral", place)
        elif kind == "decimal" and term:
            features.setdefault("Real", place)
        elif kind == "bits":
            features.setdefault("BitVec", place)
        elif kind == "keyword" and match[kind] == b":named":
            self.script.named.append((place, command.name == "assert" and self.depth == 2))
        elif kind in ("quoted", "string"):
            self.words(place, match[kind])
        return True

    def words(self, place: int, text: bytes) -> None:
        if b"(" in text:
            self.script.texts.append((place, text))

    def stray(self, match: re.Match[bytes]) -> None:
        token = match[match.lastgroup or 0][:20].decode("utf-8", "replace")
        self.wrong(match.start(match.lastgroup or 0), f"`{token}` cannot stand here")

    def wrong(self, place: int, message: str) -> None:
        if self.script.wrong is None:
            self.script.wrong = (place, message)


def scan(text: bytes) -> Script:
    """Reads a text, as far as it is SMT-LIB."""
    return Scanner(text).run()


def declarations(script: Script) -> Iterator[tuple[Command, str]]:
    """Declarations that competitions do not allow, each with what is wrong with it."""
    for command in script.commands:
        tokens = command.tokens
        if command.name == "declare-sort" and tokens[3:4] != [b"0"]:
            yield command, "declared sorts take no parameters"
        elif command.name == "define-sort" and tokens[4:5] != [b")"]:
            yield command, "defined sorts take no parameters"
        elif command.name in ("declare-datatype", "declare-datatypes") and b"par" in tokens:
            yield command, "datatypes take no parameters"
        elif command.name == "declare-datatypes":
            # ((name 0) ...)
            sorts = tokens[3 : tokens.index(b")", tokens.index(b")") + 1) if tokens.count(b")") > 1 else None]
            if any(token.isdigit() and token != b"0" for token in sorts):
                yield command, "datatypes take no parameters"
