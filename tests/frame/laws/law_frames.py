#!/usr/bin/env python3
"""Random frames with laws, and what they do, by a program that shares nothing with deflect: dense stiffness matrices in
34 digits, members and springs as matrices, and the forces in the laws by coordinate descent on the dual energy
  1/2 f'Cf - d'f + sum of the integrals of delta_i(f_i),
C the compliance of the linear rest between the laws. From the 24th on, tables are among the laws; from the 37th on,
tables and smooth laws stand in series with others, and one or two laws beside a series, at ends, supports and springs.
Writes law_frames.txt, which law_frames_test.cpp reads:

  tests/frame/laws/law_frames.py > tests/frame/laws/law_frames.txt
"""
import math
import random
import sys

from parts import D, Law, axes_of, beam_stiffness, cross, solve

NODE = ["ux", "uy", "uz", "rx", "ry", "rz"]
MEMBER = ["tx", "ty", "tz", "rx", "ry", "rz"]


class Frame:
    def __init__(self, seed):
        self.dice = dice = random.Random(seed)
        self.sequence = seed % 2 == 1
        self.more_kinds = ("table",) * 3 if seed >= 24 else ()
        self.mixed = seed >= 37
        self.frictions = []   # in deflect's order: ends, supports, springs
        n = dice.randint(4, 6)
        self.nodes = [[dice.uniform(-1, 1) + 1.5 * i, dice.uniform(-1, 1), dice.uniform(-1, 1)] for i in range(n)]
        pairs = [(i, i + 1) for i in range(n - 1)] + [(i, i + 2) for i in range(n - 2) if dice.random() < 0.6]
        self.members, self.size = [], 6 * n
        for i, (a, b) in enumerate(pairs):
            self.members.append(self.member(f"m{i}", a, b))
        self.elements = [e for m in self.members for e in m["laws"]]  # (form, laws in series)
        self.linear = [e for m in self.members for e in m["linear"]]  # (form, k)
        self.supports = {}
        for node in {0, n - 1, dice.randrange(1, n - 1)}:
            self.supports[node] = self.support(node, node in (0, n - 1))
        self.springs = [self.spring(f"s{i}", dice.randrange(n), dice.choice([None, 0, n - 1])) for i in range(2)]

    def laws(self, rotation):
        kinds = ("one_sided", "clearance", "power", "hardening", "friction") + self.more_kinds
        scale = 10 ** self.dice.uniform(4, 5.5) * (0.3 if rotation else 1)
        kind = self.dice.choice(kinds)
        out = [Law(kind, rotation, scale, self.dice)]
        if kind in ("clearance", "one_sided") and self.dice.random() < 0.6:
            behind = ["linear", "power", "hardening"] + ["table"] * 2 * self.mixed
            out.append(Law(self.dice.choice(behind), rotation, scale, self.dice))
        elif self.mixed and kind != "friction" and self.dice.random() < 0.4:
            out.append(Law(self.dice.choice(["power", "hardening", "table"]), rotation, scale, self.dice))
        return out

    def beside(self, rotation):
        """Laws side by side with a series; each is loaded by itself."""
        if not self.mixed or self.dice.random() < 0.4:
            return []
        scale = 10 ** self.dice.uniform(4, 5.5) * (0.3 if rotation else 1)
        kinds = [self.dice.choice(["friction", "friction", "hardening", "power", "table"])
                 for _ in range(self.dice.choice([1, 1, 2]))]
        return [Law(kind, rotation, scale, self.dice) for kind in kinds]

    def member(self, name, a, b):
        dice = self.dice
        along = [q - p for p, q in zip(self.nodes[a], self.nodes[b])]
        m = {"name": name, "a": a, "b": b, "R": axes_of(along), "L": math.sqrt(sum(x * x for x in along)),
             "timoshenko": dice.random() < 0.4, "factor": dice.choice([1, dice.uniform(0.3, 2)]),
             "bending": dice.choice([1, dice.uniform(0.5, 1)]),
             "misfit": dice.choice([0, 0, dice.uniform(-2e-4, 2e-4)]), "laws": [], "linear": [], "ends": {}}
        for end in ("start", "end"):
            if dice.random() < 0.6:
                continue
            keys = m["ends"][end] = {}
            for i in sorted(dice.sample(range(6), dice.choice([1, 1, 2]))):
                slot, self.size = self.size, self.size + 1
                form = {slot: 1.0 if end == "start" else -1.0}  # far side: the member, the node
                stiffness = Law("linear", i >= 3, 10 ** dice.uniform(4, 6), dice)
                m["linear"].append((form, stiffness.k))
                series, beside = [stiffness], []
                if dice.random() < 0.6:  # the law in series, and the linear one beside it
                    series, more = self.laws(i >= 3), self.beside(i >= 3)
                    beside = [stiffness] + more
                    m["laws"] += [(form, each) for each in [series] + [[law] for law in more]]
                keys[i] = (slot, series, beside)
        return m

    def support(self, node, firm):
        dice = self.dice
        rigid = [firm and dice.random() < 0.8 for _ in range(6)]
        laws = {}
        for i in range(6):
            form = {6 * node + i: 1.0}
            if firm and not rigid[i]:
                law = Law("linear", i >= 3, 10 ** dice.uniform(4.5, 6), dice)
                self.linear.append((form, law.k))
                laws[i] = ([law], [])
            elif not rigid[i] and dice.random() < 0.5:
                series, more = self.laws(i >= 3), self.beside(i >= 3)
                self.elements += [(form, each) for each in [series] + [[law] for law in more]]
                laws[i] = ([], series[:1] + more) if len(series) == 1 and dice.random() < 0.5 else (series, more)
        return {"rigid": rigid, "laws": laws}

    def spring(self, name, node, to):
        dice = self.dice
        if to == node:
            to = None
        p = self.nodes[node]
        forms = []
        for i in range(6):
            form = {6 * node + i: 1.0}
            if to is not None:
                form[6 * to + i] = form.get(6 * to + i, 0) - 1.0
                if i < 3:  # u_to + w x r
                    r = [x - y for x, y in zip(p, self.nodes[to])]
                    for j in range(3):
                        e = [0, 0, 0]
                        e[j] = 1
                        form[6 * to + 3 + j] = form.get(6 * to + 3 + j, 0) - cross(e, r)[i]
            forms.append(form)
        s = {"name": name, "node": node, "to": to, "forms": forms, "laws": {}, "K": None}
        if dice.random() < 0.4:
            B = [[dice.uniform(-1, 1) * (300 if i < 3 else 60) for _ in range(6)] for i in range(6)]
            K = [[sum(B[i][k] * B[j][k] for k in range(6)) for j in range(6)] for i in range(6)]
            s["K"] = [[K[max(i, j)][min(i, j)] for j in range(6)] for i in range(6)]
        else:
            for i in sorted(dice.sample(range(6), 2)):
                if dice.random() < 0.5:
                    law = Law("linear", i >= 3, 10 ** dice.uniform(4, 6), dice)
                    self.linear.append((forms[i], law.k))
                    s["laws"][i] = ([law], [])
                else:
                    series, more = self.laws(i >= 3), self.beside(i >= 3)
                    self.elements += [(forms[i], each) for each in [series] + [[law] for law in more]]
                    s["laws"][i] = (series, more)
        return s

    # The linear rest

    def end_map(self, m):
        """By freedom of the member's ends in its axes: {unknown: factor}."""
        rows = []
        for end, node in (("start", m["a"]), ("end", m["b"])):
            own = m["ends"].get(end, {})
            for i in range(6):
                row = {6 * node + 3 * (i // 3) + j: m["R"][i % 3][j] for j in range(3)}
                if i in own:
                    row[own[i][0]] = 1.0
                rows.append(row)
        return rows

    def assemble(self):
        K = [[D(0)] * self.size for _ in range(self.size)]

        def add(rows, k):
            rows = [{i: D(v) for i, v in row.items()} for row in rows]
            for i, a in enumerate(rows):
                for j, b in enumerate(rows):
                    if k[i][j]:
                        for p, x in a.items():
                            for q, y in b.items():
                                K[p][q] += D(k[i][j]) * x * y
        for m in self.members:
            E, G = 2e9 * m["factor"], 0.8e9 * m["factor"]
            shear = (G * 8e-5, G * 7e-5) if m["timoshenko"] else (0, 0)
            m["EA"] = E * 1e-4
            k = beam_stiffness(E * 1e-4, E * m["bending"] * 4e-7, E * m["bending"] * 2e-7, G * 5e-7, *shear, m["L"])
            add(self.end_map(m), k)
        for form, k in self.linear:
            add([form], [[k]])
        for s in self.springs:
            if s["K"]:
                add(s["forms"], s["K"])
        return K

    def load(self, case):
        F = [D(0)] * self.size
        factor = case["factor"]
        for node, wrench in case["nodes"].items():
            for i in range(6):
                F[6 * node + i] += D(factor * wrench[i])
        for m in self.members:
            rows, local = self.end_map(m), [0.0] * 12
            strain = m["misfit"] / m["L"] + factor * 1e-5 * case["heat"].get(m["name"], 0)
            local[0] -= m["EA"] * strain
            local[6] += m["EA"] * strain
            q = [factor * x for x in case["lines"].get(m["name"], (0, 0, 0))]
            L = m["L"]
            for i in range(3):
                local[i] += q[i] * L / 2
                local[6 + i] += q[i] * L / 2
            for i, s in ((1, 1), (2, -1)):
                local[6 - i] += s * q[i] * L * L / 12
                local[12 - i] -= s * q[i] * L * L / 12
            for row, f in zip(rows, local):
                for i, v in row.items():
                    F[i] += D(f) * D(v)
        return F

    def has_one_answer(self):
        """A one-sided law whose ends are both held carries anything in the sense in which it is rigid."""
        held = {6 * n + i for n, s in self.supports.items() for i in range(6) if s["rigid"][i]}
        return all(set(form) - held or any(law.delta(-1.0) for law in laws) for form, laws in self.elements)

    def solve(self, cases):
        K = self.assemble()
        held = {6 * n + i for n, s in self.supports.items() for i in range(6) if s["rigid"][i]}
        free = [i for i in range(self.size) if i not in held]
        Kff = [[K[i][j] for j in free] for i in free]
        B = [[D(form.get(i, 0.0)) for i in free] for form, _ in self.elements]
        none = {"factor": 1, "nodes": {}, "lines": {}, "heat": {}}
        loads = [self.load(c) for c in [none] + cases]
        values = [{}] + [{6 * n + i: D(c["factor"] * v) for (n, i), v in c["moves"].items()} for c in cases]
        columns = [[F[i] - sum(K[i][j] * x for j, x in v.items()) for i in free] for F, v in zip(loads, values)]
        solved = solve(Kff, columns + B)
        u0, by_law = solved[:len(columns)], solved[len(columns):]
        C = [[float(sum(a * b for a, b in zip(B[i], by_law[j]))) for j in range(len(B))] for i in range(len(B))]
        out = []
        slips = [0.0] * sum(law.kind == "friction" for _, laws in self.elements for law in laws)
        tables = [(e, law) for e, (_, laws) in enumerate(self.elements) for law in laws if law.kind == "memory"]
        lefts = [(0.0, 0.0)] * len(tables)
        frictions = [(e, law) for e, (_, laws) in enumerate(self.elements) for law in laws if law.kind == "friction"]
        for c in range(len(columns)):
            for (_, law), slip in zip(frictions, slips):
                law.slip = slip
            for (_, law), left in zip(tables, lefts):
                law.left = left
            d0 = [float(sum(a * x for a, x in zip(B[e], u0[c])) + sum(D(f) * values[c].get(i, D(0)) for i, f in
                                                                     self.elements[e][0].items()))
                  for e in range(len(B))]
            f = self.forces(C, d0)
            u = [D(0)] * self.size
            for k, i in enumerate(free):
                u[i] = u0[c][k] - sum(D(f[e]) * by_law[e][k] for e in range(len(B)))
            for i, v in values[c].items():
                u[i] = v
            delta = [d0[e] - sum(C[e][j] * f[j] for j in range(len(B))) for e in range(len(B))]
            after = []
            for e, law in frictions:
                laws = self.elements[e][1]
                rest = delta[e] - sum(other.delta(f[e]) for other in laws if other is not law)
                after.append(rest - (law.delta(f[e]) - law.slip))
            if self.sequence or c == 0:
                slips = after
                lefts = [law.after(f[e]) for e, law in tables]
            reactions = {}
            for n, s in self.supports.items():
                reactions[n] = []
                for i in range(6):
                    at = 6 * n + i
                    if s["rigid"][i]:  # all else that acts there
                        pulls = sum(K[at][j] * u[j] for j in range(self.size)) - loads[c][at]
                        pulls += sum(D(f[e] * form.get(at, 0.0)) for e, (form, _) in enumerate(self.elements))
                        reactions[n].append(float(pulls))
                    else:
                        total = -sum(k * float(u[at]) for form, k in self.linear if form == {at: 1.0} and
                                     any(law.kind == "linear" and law.k == k for law in sum(s["laws"].get(i, ([], [])),
                                                                                           [])))
                        mine = [laws for part in s["laws"].get(i, ([], [])) for laws in part]
                        total -= sum(f[e] for e, (_, laws) in enumerate(self.elements) if laws and laws[0] in mine)
                        reactions[n].append(total)
            out.append((u, reactions))
        base = out[0][0]
        return [([float(x - y) for x, y in zip(u, base)], r) for u, r in out[1:]]

    def forces(self, C, d0):
        n = len(d0)
        f = [0.0] * n
        for sweep in range(200000):
            change = 0.0
            for e in range(n):
                laws = self.elements[e][1]
                most = min(law.most for law in laws)
                rhs = d0[e] - sum(C[e][j] * f[j] for j in range(n) if j != e)

                def lacks(x):
                    return sum(law.delta(x) for law in laws) + C[e][e] * x - rhs
                # a force beyond which the other side of the equation is passed
                high = min(most, 1.0)
                while high < most and lacks(high) < 0:
                    high = min(most, 4 * high)
                low = -min(most, 1.0)
                while low > -most and lacks(low) > 0:
                    low = max(-most, 4 * low)
                if lacks(high) <= 0:
                    x = high
                elif lacks(low) >= 0:
                    x = low
                elif lacks(1e-300) >= 0 >= lacks(-1e-300):
                    x = 0.0
                else:
                    low, high = (max(low, 0.0), high) if lacks(1e-300) < 0 else (low, min(high, 0.0))
                    for _ in range(400):
                        x = (low + high) / 2
                        if x in (low, high):
                            break
                        low, high = (x, high) if lacks(x) < 0 else (low, x)
                change = max(change, abs(x - f[e]))
                f[e] = x
            if change <= 1e-15 * max(map(abs, f), default=0):
                return f
        raise RuntimeError(f"no convergence, {change:.1e}")

    # The file

    def cases(self):
        dice, out = self.dice, []
        for _ in range(3):
            firm = [(n, i) for n, s in self.supports.items() for i in range(6) if s["rigid"][i]]
            out.append({"factor": dice.choice([1, dice.uniform(-2, 2)]),
                        "nodes": {i: [dice.uniform(-50, 50) * (0.3 if j > 2 else 1) for j in range(6)]
                                  for i in dice.sample(range(len(self.nodes)), 2)},
                        "lines": {dice.choice(self.members)["name"]: [dice.uniform(-20, 20) for _ in range(3)]},
                        "heat": {dice.choice(self.members)["name"]: dice.uniform(-10, 10)},
                        "moves": {dice.choice(firm): dice.uniform(-2e-4, 2e-4)} if firm else {}})
        return out

    @staticmethod
    def lists(laws, names):
        def value(list_):
            return "[" + ", ".join(law.text for law in list_) + "]"
        parts = [f"{names[i]}: {value(series)}" for i, (series, beside) in laws.items() if series]
        beside = [f"{names[i]}: {value(beside)}" for i, (series, beside) in laws.items() if beside]
        if beside:
            parts.append("beside: {" + ", ".join(beside) + "}")
        return ", ".join(parts)

    def text(self, cases):
        out = ["name: random", "materials: {stuff: {E: 2e9 Pa, G: 0.8e9 Pa, expansion: 1e-5 1/K}}",
               "sections: {bar: {shape: given, A: 1e-4 m^2, Iy: 4e-7 m^4, Iz: 2e-7 m^4, J: 5e-7 m^4, "
               "As_y: 8e-5 m^2, As_z: 7e-5 m^2}}", "nodes:"]
        out += [f"  n{i}: [{', '.join(f'{x!r} m' for x in p)}]" for i, p in enumerate(self.nodes)]
        out.append("members:")
        for m in self.members:
            line = f"  {m['name']}: {{from: n{m['a']}, to: n{m['b']}, section: bar, material: stuff"
            line += ", beam: timoshenko" if m["timoshenko"] else ""
            line += f", factor: {m['factor']!r}" if m["factor"] != 1 else ""
            line += f", bending_factor: {m['bending']!r}" if m["bending"] != 1 else ""
            line += f", misfit: {m['misfit']!r} m" if m["misfit"] else ""
            for end, keys in m["ends"].items():
                line += f", {end}: {{{self.lists({i: (s, b) for i, (_, s, b) in keys.items()}, MEMBER)}}}"
            out.append(line + "}")
        out.append("supports:")
        for n, s in self.supports.items():
            parts = ["holds: [" + ", ".join(NODE[i] for i in range(6) if s["rigid"][i]) + "]"] if any(s["rigid"]) else []
            parts += [self.lists(s["laws"], NODE)] if s["laws"] else []
            if parts:
                out.append(f"  n{n}: {{{', '.join(parts)}}}")
        out.append("springs:")
        for s in self.springs:
            line = f"  {s['name']}: {{node: n{s['node']}" + (f", to: n{s['to']}" if s["to"] is not None else "")
            if s["K"]:
                rows = ", ".join("[" + ", ".join(repr(x) for x in row) + "]" for row in s["K"])
                line += f", stiffness: {{units: N-m, rows: [{rows}]}}"
            else:
                line += ", " + self.lists(s["laws"], NODE)
            out.append(line + "}")
        out.append("loads:")
        wrench = ["fx", "fy", "fz", "mx", "my", "mz"]
        for c, case in enumerate(cases):
            out.append(f"  c{c}:\n    factor: {case['factor']!r}\n    nodes:")
            for n, w in case["nodes"].items():
                out.append(f"      n{n}: {{" + ", ".join(f"{k}: {v!r} {'N' if i < 3 else 'Nm'}" for i, (k, v) in
                                                         enumerate(zip(wrench, w))) + "}")
            for m, q in case["lines"].items():
                out.append(f"    members: {{{m}: {{axes: member, " +
                           ", ".join(f"{k}: {v!r} N/m" for k, v in zip(("qx", "qy", "qz"), q)) + "}}")
            for m, T in case["heat"].items():
                out.append(f"    temperature: {{{m}: {T!r} K}}")
            for (n, i), v in case["moves"].items():
                out.append(f"    displacements: {{n{n}: {{{NODE[i]}: {v!r} {'m' if i < 3 else 'rad'}}}}}")
        return "\n".join(out)


def main(first):
    for seed in range(first, 53):
        frame = Frame(seed)
        if not frame.has_one_answer():
            continue
        cases = frame.cases()
        print(f"frame {seed} {'sequence' if frame.sequence else 'single'}")
        print(frame.text(cases))
        for c, (u, reactions) in enumerate(frame.solve(cases)):
            for n in range(len(frame.nodes)):
                print(f"u {c} {n} " + " ".join(f"{x:.13e}" for x in u[6 * n:6 * n + 6]))
            for i, n in enumerate(k for k, s in frame.supports.items() if any(s["rigid"]) or s["laws"]):
                print(f"r {c} {i} " + " ".join(f"{x:.13e}" for x in reactions[n]))


main(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
