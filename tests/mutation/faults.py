"""Small faults that can be set into a C++ source, each as a replacement that keeps the lines of the file.

A fault is a place in a line and a text that has the old value unless its number is chosen at run time (mutant.h), so
that all faults of a program are compiled at once. Places are found in the text by the house style (binary operators
stand between blanks, a comparison of templates never); a replacement that does not compile is dropped by the caller.
"""
import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    file: str      # in the tree
    line: int      # from 1
    kind: str
    first: int     # columns of what is replaced, from 0
    last: int
    text: str      # with {n} in place of the number
    said: str      # the changed text, for the report


def code_mask(line):
    """The line with strings, characters and comments blanked, as long as before."""
    out, i = list(line), 0
    while i < len(line):
        if line.startswith('//', i):
            out[i:] = ' ' * (len(line) - i)
            break
        if line[i] in '"\'' and not (line[i] == "'" and i > 0 and line[i - 1].isalnum()):
            end = i + 1
            while end < len(line) and line[end] != line[i]:
                end += 2 if line[end] == '\\' else 1
            for k in range(i, min(end + 1, len(line))):
                out[k] = '~'
            i = end
        i += 1
    return ''.join(out)


def closed(text, start):
    """Where the parenthesis that opens at start closes; -1 where it does not."""
    depth = 0
    for i in range(start, len(text)):
        depth += (text[i] in '([{') - (text[i] in ')]}')
        if depth == 0:
            return i
    return -1


def of_line(file, number, line):
    code = code_mask(line)
    stripped = code.strip()
    if not stripped or stripped.startswith(('#', 'template', 'static_assert', 'using', 'namespace', 'class', 'struct')):
        return
    constant = code.startswith(('constexpr double', 'const double'))
    if 'constexpr' in code and not constant or '~' in code and ' + ' in code:
        return

    def fault(kind, first, last, text):
        said = line[:first] + re.sub(r'::deflect::mutation::', '', text).replace('{n}', '…') + line[last:]
        return Fault(file, number, kind, first, last, text, said.strip())

    factor = '::deflect::mutation::factor({n}, %s) * '
    for m in re.finditer(r'(?<=[\w)\]]) ([-+]) (?=[\w(*!])', code):
        if constant:
            continue
        yield fault('sign', m.end(), m.end(), factor % '-1')
        yield fault('dropped term', m.end(), m.end(), factor % '0')
    for m in re.finditer(r'(?<=[\w)\]]) \* (?=[\w(])', code):
        yield fault('factor', m.end(), m.end(), factor % '2')
    for m in re.finditer(r'(?<=[\w)\]]) (<|>|<=|>=) (?=[\w(])', code):
        if re.match(r'0\b(?!\.)', code[m.end():]):
            continue  # half of nothing is the same
        if stripped.startswith('for ('):
            yield fault('index', m.start(), m.start(), ' + ::deflect::mutation::one({n})')
        else:
            yield fault('threshold', m.end(), m.end(), factor % '0.5')
    m = re.match(r'^(.*[\w)\]]) ([-+]=) (.*);$', code.rstrip())
    if m and closed('(' + m[3] + ')', 0) == len(m[3]) + 1 and ' = ' not in m[3]:
        old = line[m.start(3):m.end(3)]
        yield fault('sign', m.start(3), m.end(3), factor % '-1' + '(' + old + ')')
        yield fault('dropped term', m.start(3), m.end(3), factor % '0' + '(' + old + ')')
    for m in re.finditer(r'(?<![\w.])(\d+\.\d+(e-?\d+)?|\d+e-?\d+)(?![\w.])', code):
        if float(m[0]) == 0:
            continue
        yield fault('factor', m.start(), m.start(), factor % '2')
    for m in re.finditer(r'(?<=[\w)\]]\()([0-5])(?=\))|(?<=, )([0-5])(?=\))|(?<=\()([0-5])(?=, )', code):
        value = int(m[0])
        other = value - 1 if value else 1
        yield fault('index', m.start(), m.end(), '(::deflect::mutation::is({n}) ? %d : %d)' % (other, value))
    m = re.match(r'^(.*\bif )\(', code)
    if m and ';' not in code[:closed(code, m.end() - 1)] and closed(code, m.end() - 1) > 0:
        start, end = m.end(), closed(code, m.end() - 1)
        inner = line[start:end]
        if not re.match(r'(const )?(auto|double|std::optional)\b', inner) and ' = ' not in inner:
            yield fault('comparison', start, end, '::deflect::mutation::is({n}) != static_cast<bool>(' + inner + ')')
    for m in re.finditer(r'\bstd::(max|min)\((?!\{)', code):
        name = {'max': 'largest', 'min': 'smallest'}[m[1]]
        yield fault('comparison', m.start(), m.end(), '::deflect::mutation::%s({n}, ' % name)


def of_file(root, file):
    with open(root / file, encoding='utf-8') as f:
        lines = f.read().split('\n')
    return [fault for i, line in enumerate(lines) for fault in of_line(str(file), i + 1, line)]


def mutated(text, numbered):
    """The text of a file with all of these faults (number → Fault), of which none overlaps another on a line."""
    lines = text.split('\n')
    for n, fault in sorted(numbered.items(), key=lambda item: -item[1].first):
        line = lines[fault.line - 1]
        lines[fault.line - 1] = line[:fault.first] + fault.text.replace('{n}', str(n)) + line[fault.last:]
        if line.startswith('constexpr double'):
            lines[fault.line - 1] = lines[fault.line - 1].replace('constexpr', 'const', 1)
    return '#include "tests/mutation/mutant.h"\n#line 1\n' + '\n'.join(lines)
