"""Writes golden.json: rays with their exact light, to 30 digits.

Computed from the definitions in src/volume, src/transfer and src/scene alone, in 50-digit arithmetic, by other means than
the oracle's: polynomials in power form, all complex roots at once (Durand-Kerner), 40-node Gauss-Legendre quadrature held
against its halves. Nothing here reads or runs the Rust.

    pip install mpmath && python tests/oracle/golden.py
"""

import json
import random
from pathlib import Path

from mpmath import mp, mpf

mp.dps = 50
RANDOM = random.Random(2014)


# The definitions: field, transfer function, shading.

def lerp(a, b, t):
    return a + t * (b - a)


class Field:
    def __init__(self, case):
        self.dims = case["dims"]
        self.stored = case["stored"]
        self.slope, self.intercept = mpf(case["slope"]), mpf(case["intercept"])
        columns = [[mpf(x) for x in column] for column in case["matrix"]]
        self.to_mm = mp.matrix(3, 3)
        for a in range(3):
            for row in range(3):
                self.to_mm[row, a] = columns[a][row]
        self.to_index = self.to_mm ** -1
        self.translation = [mpf(x) for x in case["translation"]]

    def value(self, voxel):
        nx, ny, _ = self.dims
        i, j, k = voxel
        return self.slope * self.stored[i + nx * (j + ny * k)] + self.intercept

    def gradient(self, voxel):
        per_index = []
        for a in range(3):
            low, high = list(voxel), list(voxel)
            low[a] = max(voxel[a] - 1, 0)
            high[a] = min(voxel[a] + 1, self.dims[a] - 1)
            steps = high[a] - low[a]
            per_index.append((self.value(high) - self.value(low)) / steps if steps else mpf(0))
        # The inverse transpose takes covectors to mm.
        return [sum(self.to_index[row, axis] * per_index[row] for row in range(3)) for axis in range(3)]

    def corners(self, cell, of_voxel):
        def corner(c):
            return of_voxel([min(cell[a] + (c >> a & 1), self.dims[a] - 1) for a in range(3)])
        return [corner(c) for c in range(8)]


def trilinear(corners, x):
    rows = [lerp(corners[c], corners[c + 1], x[0]) for c in (0, 2, 4, 6)]
    return lerp(lerp(rows[0], rows[1], x[1]), lerp(rows[2], rows[3], x[1]), x[2])


def piecewise_linear(knots, x, from_right):
    """Value at x of [position, value...] knots, sorted; constant beyond them; a jump is two knots at one position."""
    before = [k for k in knots if (k[0] <= x if from_right else k[0] < x)]
    after = knots[len(before):]
    if not before:
        return after[0][1:]
    if not after:
        return before[-1][1:]
    low, high = before[-1], after[0]
    u = (x - low[0]) / (high[0] - low[0])
    return [lerp(a, b, u) for a, b in zip(low[1:], high[1:])]


class TransferFunction:
    def __init__(self, case):
        def exact(rows):
            return [[mpf(x) for x in row] for row in rows]
        self.window = [mpf(x) for x in case["window"]]
        self.range = mpf(case["gradient_range"])
        self.terms = [(exact(t["knots"]), exact(t["weight"]) if t["weight"] else None) for t in case["terms"]]
        self.value_knots = {k[0] for knots, _ in self.terms for k in knots} | set(self.window)
        self.gradient_knots = {k[0] for _, weight in self.terms if weight for k in weight} | {mpf(0), self.range}

    def __call__(self, value, gradient):
        v = min(max(value, self.window[0]), self.window[1])
        g = min(max(gradient, mpf(0)), self.range)
        optics = [mpf(0)] * 4
        for knots, weight in self.terms:
            w = piecewise_linear(weight, g, gradient < self.range)[0] if weight else mpf(1)
            term = piecewise_linear(knots, v, value < self.window[1])
            optics = [a + w * b for a, b in zip(optics, term)]
        return optics


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Shading:
    def __init__(self, parameters, direction):
        p = parameters
        self.ambient, self.diffuse, self.specular = (mpf(p[k]) for k in ("ambient", "diffuse", "specular"))
        self.shininess, self.soft = mpf(p["shininess"]), mpf(p["soft_gradient"])
        self.two_sided = p["two_sided"]
        eye = [-x for x in direction]
        self.lights = []
        for light in p["lights"]:
            towards = [mpf(x) for x in light["towards"]] if light["towards"] else eye
            total = [a + b for a, b in zip(towards, eye)]
            half = [x / mp.sqrt(dot(total, total)) for x in total] if light["towards"] else eye
            self.lights.append((towards, half, [mpf(x) for x in light["color"]]))

    def __call__(self, optics, gradient):
        reflected, highlight = [self.ambient] * 3, [mpf(0)] * 3
        square = dot(gradient, gradient)
        if square > 0:
            fade = square / (square + self.soft ** 2)
            normal = [-x / mp.sqrt(square) for x in gradient]
            side = abs if self.two_sided else (lambda x: max(x, mpf(0)))
            for towards, half, color in self.lights:
                lit, shine = side(dot(normal, towards)), side(dot(normal, half))
                gloss = shine ** self.shininess if lit > 0 else mpf(0)
                for c in range(3):
                    reflected[c] += self.diffuse * color[c] * fade * lit
                    highlight[c] += self.specular * color[c] * fade * gloss
        return [optics[1 + c] * reflected[c] + optics[0] * highlight[c] for c in range(3)]


# Polynomials in power form, lowest power first.

def fit(f, degree, a, b):
    """The polynomial of (s - a)/(b - a) through degree + 1 values of f on [a, b]."""
    nodes = [mpf(i) / degree for i in range(degree + 1)]
    matrix = mp.matrix(degree + 1, degree + 1)
    for row, t in enumerate(nodes):
        for power in range(degree + 1):
            matrix[row, power] = t ** power
    right = mp.matrix([f(lerp(a, b, t)) for t in nodes])
    return list(mp.lu_solve(matrix, right))


def times(p, q):
    product = [mpf(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] += a * b
    return product


def roots(p):
    """Real roots in (0, 1)."""
    size = max(abs(c) for c in p)
    p = list(p)
    while p and abs(p[-1]) <= size * mpf(10) ** -40:
        p.pop()
    if len(p) < 2:
        return []
    found = mp.polyroots(p[::-1], maxsteps=500, extraprec=400, error=False)
    return [mp.re(r) for r in found if abs(mp.im(r)) < mpf(10) ** -20 and 0 < mp.re(r) < 1]


def derivative(p):
    return [k * c for k, c in enumerate(p)][1:]


def gauss_legendre(n):
    rule = []
    for i in range(n):
        x = mp.cos(mp.pi * (i + mpf(3) / 4) / (n + mpf(1) / 2))
        for _ in range(10):
            before, p = mpf(1), x
            for k in range(2, n + 1):
                before, p = p, ((2 * k - 1) * x * p - (k - 1) * before) / k
            slope = n * (x * p - before) / (x * x - 1)
            x -= p / slope
        rule.append(((1 + x) / 2, 1 / ((1 - x * x) * slope ** 2)))
    return rule


GAUSS = gauss_legendre(40)


def integrate(f, a, b, depth=0):
    """Integral of a list-valued f over [a, b], refined until halving changes less than 1e-32."""
    def panel(x, y):
        total = None
        for t, w in GAUSS:
            term = [w * (y - x) * v for v in f(lerp(x, y, t))]
            total = term if total is None else [p + q for p, q in zip(total, term)]
        return total
    middle = (a + b) / 2
    whole, near, far = panel(a, b), panel(a, middle), panel(middle, b)
    halves = [p + q for p, q in zip(near, far)]
    if max(abs(p - q) for p, q in zip(whole, halves)) < mpf(10) ** -32:
        return halves
    assert depth < 60, "the quadrature does not converge"
    near, far = integrate(f, a, middle, depth + 1), integrate(f, middle, b, depth + 1)
    return [p + q for p, q in zip(near, far)]


# The volume rendering integral.

def radiance(case):
    field, transfer = Field(case), TransferFunction(case)
    direction = [mpf(x) for x in case["direction"]]
    start = mp.matrix([mpf(o) - t for o, t in zip(case["origin"], field.translation)])
    index, step = field.to_index * start, field.to_index * mp.matrix(direction)
    shading = Shading(case["shading"], direction) if case["shading"] else None

    first, last = mpf(0), mpf("inf")
    for a, n in enumerate(field.dims):
        low, high = (mpf(-0.5), mpf(0.5)) if n == 1 else (mpf(0), mpf(n - 1))
        if step[a] == 0:
            if not low <= index[a] <= high:
                return [mpf(0)] * 4
            continue
        x, y = (low - index[a]) / step[a], (high - index[a]) / step[a]
        first, last = max(first, min(x, y)), min(last, max(x, y))
    if not first < last:
        return [mpf(0)] * 4

    faces = {first, last}
    for a, n in enumerate(field.dims):
        if n > 1 and step[a] != 0:
            crossings = ((k - index[a]) / step[a] for k in range(n))
            faces |= {s for s in crossings if first < s < last}
    faces = sorted(faces)

    rgb, depth = [mpf(0)] * 3, mpf(0)
    for a, b in zip(faces, faces[1:]):
        if b - a < mpf(10) ** -40:
            continue
        middle = (a + b) / 2
        cell = [0 if n == 1 else min(int(mp.floor(index[i] + middle * step[i])), n - 2) for i, n in enumerate(field.dims)]

        def position(s):
            return [index[i] + s * step[i] - cell[i] if n > 1 else mpf(0) for i, n in enumerate(field.dims)]

        gradients = field.corners(cell, field.gradient)
        channels = {
            "value": field.corners(cell, field.value),
            "magnitude": [mp.sqrt(dot(g, g)) for g in gradients],
        } | {axis: [g[i] for g in gradients] for i, axis in enumerate("xyz")}

        def at(name, s):
            return trilinear(channels[name], position(s))

        cubic = {name: fit(lambda s: at(name, s), 3, a, b) for name in channels}
        cuts = {mpf(0), mpf(1)}
        for name, knots in (("value", transfer.value_knots), ("magnitude", transfer.gradient_knots)):
            for knot in knots:
                cuts |= set(roots([cubic[name][0] - knot] + cubic[name][1:]))
        if shading:
            for towards, half, _ in shading.lights:
                for vector in (towards, half):
                    cuts |= set(roots([dot(vector, [cubic[c][k] for c in "xyz"]) for k in range(4)]))
            squares = [times(cubic[c], cubic[c]) for c in "xyz"]
            cuts |= set(roots(derivative([sum(s[k] for s in squares) for k in range(7)])))
        cuts = sorted(cuts)
        for u, v in zip(cuts, cuts[1:]):
            if v - u < mpf(10) ** -40:
                continue
            p, q = lerp(a, b, u), lerp(a, b, v)

            def optics(s):
                return transfer(at("value", s), at("magnitude", s))

            # Strictly inside, where the transfer function is one polynomial.
            inside = (p + (q - p) / 1000, q - (q - p) / 1000)
            extinction = fit(lambda s: optics(s)[0], 6, *inside)

            def optical_depth(s):
                def antiderivative(t):
                    return (inside[1] - inside[0]) * sum(c * t ** (k + 1) / (k + 1) for k, c in enumerate(extinction))
                place = [(x - inside[0]) / (inside[1] - inside[0]) for x in (p, s)]
                return antiderivative(place[1]) - antiderivative(place[0])

            def light(s):
                o = optics(s)
                emission = shading(o, [at(c, s) for c in "xyz"]) if shading else o[1:]
                t = mp.exp(-depth - optical_depth(s))
                return [t * e for e in emission]

            rgb = [x + y for x, y in zip(rgb, integrate(light, p, q))]
            depth += optical_depth(q)
    return rgb + [-mp.expm1(-depth)]


# The cases.

def unit(vector):
    length = float(mp.sqrt(sum(mpf(x) ** 2 for x in vector)))
    return [x / length for x in vector]


def colored(value, extinction, color):
    return [value, extinction] + [extinction * c for c in color]


RED, BONE, BLUE = [1.0, 0.25, 0.125], [0.875, 0.75, 0.5], [0.125, 0.375, 1.0]

FUNCTIONS = {
    "ramp": ([{"knots": [colored(0.0, 0.0, BONE), colored(1000.0, 1.5, BONE)], "weight": None}]),
    "two tissues": [
        {"knots": [colored(-200.0, 0.0, RED), colored(0.0, 0.75, RED), colored(150.0, 0.0, RED)], "weight": None},
        {"knots": [colored(100.0, 0.0, BONE), colored(400.0, 2.5, BLUE), colored(1200.0, 3.0, BONE)], "weight": None},
    ],
    "steps": [{
        "knots": [
            colored(-100.0, 0.0, RED), colored(-100.0, 0.5, RED), colored(250.0, 0.5, RED),
            colored(250.0, 4.0, BLUE), colored(600.0, 1.0, BONE), colored(600.0, 0.0, BONE),
        ],
        "weight": None,
    }],
    "thin shells": [
        {"knots": [colored(c - 10.0, 0.0, k), colored(c, 12.0, k), colored(c + 10.0, 0.0, k)], "weight": None}
        for c, k in ((-250.0, RED), (50.0, BONE), (425.0, BLUE))
    ],
    "emission of its own": [{
        "knots": [[-500.0, 0.0, 0.25, 0.0, 0.125], [200.0, 0.5, 0.0, 1.0, 0.0], [900.0, 0.0, 2.0, 0.5, 0.0]],
        "weight": None,
    }],
    "emission alone": [{"knots": [[-500.0, 0.0, 0.0, 0.25, 1.0], [500.0, 0.0, 1.0, 0.5, 0.0]], "weight": None}],
    "opaque": [{"knots": [colored(100.0, 0.0, BONE), colored(140.0, 900.0, BONE)], "weight": None}],
    "edges": [{
        "knots": [colored(-200.0, 0.0, BLUE), colored(300.0, 2.0, RED), colored(900.0, 1.0, BONE)],
        "weight": [[20.0, 0.0], [150.0, 1.0], [400.0, 0.25]],
    }],
    "edges and bulk": [
        {"knots": [colored(-300.0, 0.25, RED), colored(500.0, 1.5, BONE)], "weight": [[0.0, 1.0], [180.0, 0.0]]},
        {"knots": [colored(0.0, 0.0, BLUE), colored(100.0, 3.0, BLUE), colored(100.0, 0.5, RED)],
         "weight": [[100.0, 0.0], [220.0, 2.0], [220.0, 0.5], [350.0, 1.5]]},
        {"knots": [[-400.0, 0.0, 0.0, 0.0, 0.0], [800.0, 0.0, 0.25, 0.5, 0.125]], "weight": None},
    ],
    "window within": [{
        "knots": [colored(-150.0, 0.25, RED), colored(350.0, 2.0, BLUE), colored(350.0, 9.0, BONE)],
        "weight": [[50.0, 0.25], [250.0, 1.0], [250.0, 7.0]],
    }],
}
WINDOWS = {"window within": ([-150.0, 350.0], 250.0)}

ISOTROPIC = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0, 0.0, 0.0])
ANISOTROPIC = ([[0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 5.0]], [-120.0, 35.5, 700.25])
SHEARED = ([[0.75, 0.1, 0.0], [-0.2, 0.9, 0.3], [0.0, 0.7, 2.5]], [10.0, -20.0, 30.0])
LEFT_HANDED = ([[0.0, 1.25, 0.0], [1.5, 0.0, 0.0], [0.1, 0.0, 2.0]], [-3.0, 4.0, 250.0])
DOME = [1000 - 90 * (i - 1) ** 2 - 120 * (j - 1) ** 2 - 150 * (k - 1) ** 2 for k in range(3) for j in range(3) for i in range(3)]
SADDLE = [890 + 200 * i * j - 300 * i - 260 * j for k in range(2) for j in range(4) for i in range(4)]
SHADING = {
    "headlight": {"ambient": 0.125, "diffuse": 0.75, "specular": 0.25, "shininess": 20.0, "two_sided": True,
                  "soft_gradient": 0.0, "lights": [{"towards": None, "color": [1.0, 1.0, 1.0]}]},
    "glint": {"ambient": 0.125, "diffuse": 0.0, "specular": 1.0, "shininess": 20.0, "two_sided": True,
              "soft_gradient": 0.0, "lights": [{"towards": None, "color": [1.0, 1.0, 1.0]}]},
    "one-sided lamp": {"ambient": 0.25, "diffuse": 0.5, "specular": 0.5, "shininess": 8.5, "two_sided": False,
                       "soft_gradient": 60.0,
                       "lights": [{"towards": unit([1.0, -2.0, 2.5]), "color": [1.0, 0.875, 0.75]}]},
    "two lamps": {"ambient": 0.0, "diffuse": 1.0, "specular": 0.25, "shininess": 1.0, "two_sided": False,
                  "soft_gradient": 10.0,
                  "lights": [{"towards": unit([-3.0, 1.0, 0.5]), "color": [0.5, 0.25, 1.0]},
                             {"towards": None, "color": [0.75, 1.0, 0.5]}]},
}


def to_mm(affine, index):
    matrix, translation = affine
    return [sum(matrix[a][row] * index[a] for a in range(3)) + translation[row] for row in range(3)]


def case(name, dims, affine, function, entry, exit, *, shading=None, back=0.0, rescale=(1.0, 0.0), stored=None, ray=None):
    """A ray through the points with indices `entry` and `exit`, from `back` times their distance before the first."""
    count = dims[0] * dims[1] * dims[2]
    low, high = ((-600 - rescale[1]) / rescale[0], (1100 - rescale[1]) / rescale[0])
    stored = stored or [RANDOM.randint(int(low), int(high)) for _ in range(count)]
    p, q = to_mm(affine, entry), to_mm(affine, exit)
    origin = [a - back * (b - a) for a, b in zip(p, q)]
    direction = unit([b - a for a, b in zip(p, q)])
    if ray:
        origin, direction = ray
    window, gradient_range = WINDOWS.get(function, ([-1024.0, 3071.0], 5000.0))
    return {
        "name": f"{name}, {function}" + (f", {shading}" if shading else ""),
        "dims": dims, "stored": stored, "slope": rescale[0], "intercept": rescale[1],
        "matrix": affine[0], "translation": affine[1],
        "window": window, "gradient_range": gradient_range, "terms": FUNCTIONS[function],
        "shading": SHADING.get(shading), "origin": origin, "direction": direction,
    }


def cases():
    skew = ([-0.4, 0.13, 0.31], [1.5, 0.91, 0.64])
    through = ([-0.2, 0.35, 1.9], [2.3, 1.6, 0.15])
    for function in FUNCTIONS:
        yield case("one cell", [2, 2, 2], ISOTROPIC, function, *skew, back=1.0)
        yield case("27 voxels, sheared", [3, 3, 3], SHEARED, function, *through, back=2.0)
    for function in ("two tissues", "steps", "edges and bulk"):
        yield case("anisotropic", [3, 3, 3], ANISOTROPIC, function, *through, back=0.5)
        yield case("left-handed", [3, 2, 3], LEFT_HANDED, function, [2.2, 0.8, -0.1], [-0.3, 0.1, 2.4], back=0.3)
    yield case("half-unit rescale", [2, 3, 2], ISOTROPIC, "two tissues", [0.1, -0.2, 0.2], [0.8, 2.2, 0.9],
               rescale=(0.5, -1024.0))
    yield case("from within", [3, 3, 3], SHEARED, "steps", [0.7, 1.2, 1.1], [2.4, 0.2, 1.8])
    yield case("along an edge", [3, 3, 3], ISOTROPIC, "two tissues", [-1.0, 1.0, 1.0], [3.0, 1.0, 1.0])
    yield case("in a face", [3, 3, 3], ISOTROPIC, "edges", [-0.5, 0.25, 1.0], [2.5, 1.75, 1.0])
    yield case("through corners", [3, 3, 3], ISOTROPIC, "two tissues", [-1.0, -1.0, -1.0], [3.0, 3.0, 3.0])
    yield case("a thick slice", [3, 3, 1], ANISOTROPIC, "edges and bulk", [0.2, 0.4, -1.0], [1.8, 1.1, 1.0])
    yield case("one voxel", [1, 1, 1], SHEARED, "edges and bulk", [-1.0, -0.7, -0.8], [1.0, 0.9, 0.7], stored=[37])
    yield case("a plateau at a step", [2, 2, 2], ISOTROPIC, "steps", *skew, stored=[250] * 8)
    yield case("a kilometre away", [3, 3, 3], ISOTROPIC, "two tissues", [0, 0, 0], [1, 1, 1],
               ray=([0.7, 1.3 - 1.0e6 * 0.6, 1.1 - 1.0e6 * 0.8], [0.0, 0.6, 0.8]))
    # A dome: along the ray the value turns exactly at a knot of the thin shells (60), in a face.
    yield case("touching a knot", [3, 1, 1], ISOTROPIC, "thin shells", [-0.1, 0.0, 0.1], [2.1, 0.1, -0.1],
               stored=[-200, 60, -200])
    # Along the diagonal the value is a parabola with its top exactly at a step (600).
    yield case("a parabola touching a step", [2, 2, 2], ISOTROPIC, "steps", [-0.5, -0.5, 0.25], [1.5, 1.5, 0.25],
               stored=[0, 1200, 1200, 0] * 2)
    # Where the saddle's gradient turns, it faces the eye for 1e-4 of a cell: a highlight that sampling would never meet.
    yield case("a glint beside a saddle", [4, 4, 2], ISOTROPIC, "ramp",
               [-1.0, 1.5 + 2.0 ** -13, 0.5], [4.0, 1.5 + 2.0 ** -13, 0.5], stored=SADDLE, shading="glint")
    for shading in SHADING:
        for function in ("ramp", "two tissues", "edges and bulk"):
            yield case("one cell", [2, 2, 2], SHEARED, function, *skew, back=1.0, shading=shading)
        yield case("27 voxels", [3, 3, 3], ANISOTROPIC, "steps", *through, back=1.0, shading=shading)
        # Past the top of a dome, where the gradient nearly vanishes and its direction turns within a thousandth of a cell.
        yield case("past a summit", [3, 3, 3], ISOTROPIC, "ramp", [-0.5, 0.9, 0.75], [2.5, 1.1002, 1.2501],
                   stored=DOME, shading=shading)


def main():
    golden = []
    for c in cases():
        rgba = radiance(c)
        golden.append(c | {"rgba": [mp.nstr(x, 30, strip_zeros=False) for x in rgba]})
        print(f"{len(golden):3d}  {c['name']:50s}", " ".join(mp.nstr(x, 10) for x in rgba), flush=True)
    lines = ",\n".join(json.dumps(g) for g in golden)
    Path(__file__).with_name("golden.json").write_text(f"[\n{lines}\n]\n")


if __name__ == "__main__":
    main()
