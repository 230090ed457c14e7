"""What law_frames.py is made of: linear algebra in 34 digits, members, laws."""
import math
from decimal import Decimal, getcontext

getcontext().prec = 34
D = Decimal


def solve(matrix, columns):
    """Gauss with partial pivoting; columns: list of right-hand sides."""
    n = len(matrix)
    rows = [list(matrix[i]) + [c[i] for c in columns] for i in range(n)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        inverse = 1 / rows[k][k]
        for i in range(k + 1, n):
            factor = rows[i][k] * inverse
            if factor:
                rows[i] = [a - factor * b if b else a for a, b in zip(rows[i], rows[k])]
    out = []
    for c in range(len(columns)):
        x = [D(0)] * n
        for i in reversed(range(n)):
            x[i] = (rows[i][n + c] - sum(rows[i][j] * x[j] for j in range(i + 1, n))) / rows[i][i]
        out.append(x)
    return out


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    size = math.sqrt(sum(x * x for x in a))
    return [x / size for x in a]


def axes_of(along):
    """Rows x, y, z: y in the plane of the member and the base z, on its side."""
    x = unit(along)
    up = [1, 0, 0] if math.hypot(*along[:2]) < 1e-3 * math.sqrt(sum(v * v for v in along)) else [0, 0, 1]
    z = unit(cross(x, up))
    return [x, cross(z, x), z]


def beam_stiffness(EA, EIy, EIz, GJ, GAy, GAz, L):
    k = [[0.0] * 12 for _ in range(12)]

    def put(i, j, v):
        k[i][j] = k[j][i] = v

    for at, stiffness in ((0, EA / L), (3, GJ / L)):
        put(at, at, stiffness)
        put(at + 6, at + 6, stiffness)
        put(at, at + 6, -stiffness)
    for v, r, EI, GA, s in ((1, 5, EIz, GAy, 1), (2, 4, EIy, GAz, -1)):
        phi = 12 * EI / (GA * L * L) if GA else 0.0
        c = EI / (L ** 3 * (1 + phi))
        put(v, v, 12 * c)
        put(v + 6, v + 6, 12 * c)
        put(v, v + 6, -12 * c)
        for i, sign in ((r, s), (r + 6, s)):
            put(v, i, sign * 6 * c * L)
            put(v + 6, i, -sign * 6 * c * L)
        put(r, r, (4 + phi) * c * L * L)
        put(r + 6, r + 6, (4 + phi) * c * L * L)
        put(r, r + 6, (2 - phi) * c * L * L)
    return k


def straight(points, x, beyond):
    """Between points; nothing before the first, and on with `beyond` after the last."""
    if x <= points[0][0]:
        return 0.0
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return points[-1][1] + beyond * (x - points[-1][0])


class Law:
    """One law: text for the file, and the deflection at a force; limits of the force for a friction."""

    def __init__(self, kind, rotation, scale, dice):
        # scale: a stiffness of the frame
        self.kind = kind
        self.most = math.inf
        self.slip = 0.0
        self.rotation = rotation
        m, f = ("rad", "moment") if rotation else ("m", "force")
        N, per = ("Nm", "Nm/rad") if rotation else ("N", "N/m")
        u = dice.uniform
        if kind == "linear":
            k = scale * u(0.5, 2)
            self.text = f"{{law: linear, stiffness: {k!r} {per}}}"
            self.k = k
            self.delta = lambda force: force / k
        elif kind == "one_sided":
            pull, push = 10 / scale * u(0.1, 5), u(0, 0.2) / scale if dice.random() < 0.6 else 0.0
            back = f", push: {push!r} {'rad/Nm' if rotation else 'm/N'}" if push else ""
            self.text = f"{{law: one_sided, pull: {pull!r} {'rad/Nm' if rotation else 'm/N'}{back}}}"
            self.delta = lambda force: (pull if force > 0 else push) * force
        elif kind == "clearance":
            gap = u(1e-5, 3e-4)
            self.text = f"{{law: clearance, gap: {gap!r} {m}}}"
            self.delta = lambda force: math.copysign(gap, force) if force else 0.0
        elif kind == "power":
            d, F, n = u(1e-5, 1e-4), u(20, 200), u(0.6, 1)
            self.text = f"{{law: power, deflection: {d!r} {m}, {f}: {F!r} {N}, exponent: {n!r}}}"
            self.delta = lambda force: math.copysign(d * abs(force / F) ** n, force)
        elif kind == "hardening":
            k, ref = scale * u(0.2, 1), u(1e-4, 1e-3)
            self.text = f"{{law: hardening, stiffness: {k!r} {per}, reference: {ref!r} {m}}}"

            def delta(force):  # of y + y^3 = g, by 4 sinh^3 t + 3 sinh t = sinh 3t
                return 2 / math.sqrt(3) * ref * math.sinh(math.asinh(1.5 * math.sqrt(3) * force / (k * ref)) / 3)
            self.delta = delta
        elif kind == "table":
            self.table(u, scale, m, f, N, dice)
        else:
            k, F = scale * u(1, 5), u(1, 60)
            self.text = f"{{law: friction, {f}: {F!r} {N}, stiffness: {k!r} {per}}}"
            self.most = F
            self.delta = lambda force: self.slip + force / k

    def table(self, u, scale, m, f, N, dice):
        """Points in steps of whole slopes over the compliance of the frame; half of the tables unload by themselves."""
        loads, up = [0.0], [0.0]
        for _ in range(dice.randint(2, 4)):
            loads.append(loads[-1] + u(3, 25))
            up.append(up[-1] + u(0.3, 4) / scale * (loads[-1] - loads[-2]))
        points = list(zip(loads, up))

        def text(rows):
            return "[" + ", ".join(f"[{p!r} {N}, {d!r} {m}]" for p, d in rows) + "]"
        if dice.random() < 0.5:
            self.text = f"{{law: table, points: {text(points)}}}"
            last = (up[-1] - up[-2]) / (loads[-1] - loads[-2])
            self.delta = lambda force: math.copysign(straight(points, abs(force), last), force)
            return
        self.kind = "memory"
        self.left = (0.0, 0.0)
        down = [up[-1]]
        for d in reversed(up[:-1]):
            down.append(d + (down[-1] - d) * u(0.1, 0.9))
        down.reverse()
        self.text = f"{{law: table, points: {text(points)}, unloading: {text(list(zip(loads, down))[::-1])}}}"
        slopes = [(b - a) / (y - x) for curve in (up, down) for a, b, x, y in zip(curve, curve[1:], loads, loads[1:])]
        c = min(slopes)
        A = [(x, d - c * x) for x, d in points]
        B = [(x, d - c * x) for x, d in zip(loads, down)]
        F, left = loads[-1], B[0][1]
        B.insert(0, (-left / max((B[1][1] - B[0][1]) / (B[1][0] - B[0][0]), left / F), 0.0))
        beyond = (A[-1][1] - A[-2][1]) / (A[-1][0] - A[-2][0])

        def after(force):
            return tuple(max(straight(A, x, beyond), min(straight(B, x, beyond), p))
                         for x, p in zip((force, -force), self.left))

        def delta(force):
            p = after(force)
            return c * force + p[0] - p[1]
        self.after, self.delta = after, delta
