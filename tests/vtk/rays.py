"""VTK's GPU shader for chosen rays, once more in numpy: in f32 as it computes, or in f64, so that what rounding does can be told from
what the shader does.

Follows the fragment shader that VTK 9.7 composes for one volume of one component, composited, without clipping: texture coordinates of
samples are added up step by step, and they, the values and all that follows are of one type.
"""

import numpy as np

from bridge import render_vtk

# In the exported script, where the volume has got all that it has.
DRESSED = "    volume.SetProperty(appearance)\n"
REVEALED = DRESSED + (
    "    volume.GetShaderProperty().AddFragmentShaderReplacement(\n"
    "        '//VTK::RenderToImage::Exit', True, 'fragOutput0 = vec4({what}, 1.0);', False)\n"
)
# A ray stops when its opacity is above this.
SATURATED = 1 - 1 / 255


def absorbed(extinction_per_mm, mm):
    return -np.expm1(-extinction_per_mm * mm)


class Rays:
    """Rays by the texture coordinates of their first sample and of a step, (n, 3) each: the middle of voxel i is at (i + 1/2)/n."""

    def __init__(self, first, step):
        self.first, self.step = first, step

    def of(self, kind):
        return Rays(self.first.astype(kind), self.step.astype(kind))


def exact_rays(described, dims, pixels):
    """The rays through the middles of pixels, (n, 2) of row and column, as the scene has them, in f64. Each meets the volume."""
    camera, spacing = described["camera"], np.array(described["spacing_mm"])
    (width, height), (row, column) = camera["size"], np.array(pixels, float).T[..., None]
    forward, up = np.array(camera["forward"]), np.array(camera["up"])
    slope = np.tan(np.radians(camera["fov_degrees_or_height_mm"]) / 2)
    direction = forward + ((2 * column + 1 - width) * np.cross(forward, up) + (height - 2 * row - 1) * up) / height * slope
    direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
    motion = np.array(described["motion"])
    origin, direction = (np.array(camera["position_mm"]) - motion[:, 3]) @ motion[:, :3], direction @ motion[:, :3]
    faces = np.stack([-origin / direction, ((dims - 1) * spacing - origin) / direction])
    entry = faces.min(0).max(-1, keepdims=True)
    step = described["step_mm"] * direction / spacing / dims
    return Rays(((origin + entry * direction) / spacing + 0.5) / dims + step, step)


def vtk_rays(folder):
    """The pixels in which VTK has rays, and these as its rasterizer hands them to the shader, which tells them in place of colours."""
    script, told = (folder / "render.py").read_text(), []
    assert script.count(DRESSED) == 1, "where the script dresses the volume"
    for what in ("g_rayOrigin", "g_dirStep"):
        (folder / "reveal.py").write_text(script.replace(DRESSED, REVEALED.format(what=what)))
        render_vtk(folder, "gpu", folder / f"{what}.npy", script="reveal.py")
        told.append(np.load(folder / f"{what}.npy"))
    pixels = np.argwhere(told[0][..., 3] > 0)
    return pixels, Rays(*(picture[*pixels.T][:, :3] for picture in told))


class Shader:
    """What VTK's shader reads of a scene: values from 0 to 1, opacities of a step and colours of (n) and (n, 3) entries, and shading."""

    def __init__(self, described, values, opacity_per_mm, colors):
        """Of entries with opacities of 1 mm, over the range of the values."""
        low, high = float(values.min()), float(values.max())
        self.values = (values.astype(np.float64) - low) / (high - low)
        self.range, self.step_mm = high - low, described["step_mm"]
        # VTK does not correct opacities of up to 1e-4.
        corrected = 1 - (1 - opacity_per_mm) ** self.step_mm
        self.opacity, self.colors = np.where(opacity_per_mm > 1e-4, corrected, opacity_per_mm), colors
        self.shading = described["shading"]
        self.dims, self.spacing = np.array(values.shape[::-1]), np.array(described["spacing_mm"])

    def march(self, rays, kind):
        """Premultiplied RGBA of the rays, (n, 4), computed with numbers of a type. The one sample of a ray that is shorter than a
        step lies behind the volume."""
        return March(self, rays.of(kind), kind).pixels


class March:
    """Rays on their way, in numbers of one type."""

    def __init__(self, shader, rays, kind):
        self.kind, self.shader, self.step = kind, shader, rays.step
        self.dims, self.values = shader.dims.astype(kind), shader.values.astype(kind)
        self.opacity, self.colors = shader.opacity.astype(kind), shader.colors.astype(kind)
        self.pixels = np.zeros((len(rays.first), 4), kind)
        position, going = rays.first.copy(), np.arange(len(rays.first))
        last, before = ((shader.dims - 0.5) / shader.dims).astype(kind), (0.5 / shader.dims).astype(kind)
        while len(going):
            self.sample(position[going], going)
            position[going] += self.step[going]
            at, step = position[going], self.step[going]
            outside = (np.maximum(step, 0) * (at - last) > 0) | (np.minimum(step, 0) * (at - before) > 0)
            going = going[~outside.any(-1) & (self.pixels[going, 3] <= kind(SATURATED))]

    def sample(self, position, going):
        value = self.value(position)
        alpha = lookup(value, self.opacity)
        visible = alpha > 0
        position, going, value, alpha = position[visible], going[visible], value[visible], alpha[visible, None]
        color = np.stack([lookup(value, column) for column in self.colors.T], axis=-1)
        if self.shader.shading:
            color = np.clip(self.lit(color, position, self.step[going]), 0, 1)
        self.pixels[going] += (1 - self.pixels[going, 3:]) * np.concatenate([color * alpha, alpha], axis=-1)

    def value(self, position):
        """Linear between voxels, constant beyond."""
        index = np.clip(position * self.dims - self.kind(0.5), 0, self.dims - 1)
        i = np.minimum(index.astype(int), self.shader.dims - 2)
        u = index - i.astype(self.kind)
        corner = self.values.ravel()
        n_x, n_y, _ = self.shader.dims
        base = (i[:, 2] * n_y + i[:, 1]) * n_x + i[:, 0]
        along_x = [mix(corner[base + a], corner[base + a + 1], u[:, 0]) for a in (0, n_x, n_x * n_y, n_x * n_y + n_x)]
        return mix(mix(along_x[0], along_x[1], u[:, 1]), mix(along_x[2], along_x[3], u[:, 1]), u[:, 2])

    def lit(self, color, position, step):
        """Phong's model with a headlight, by differences that reach 1/(n - 1) of an axis to either side."""
        shading, kind = self.shader.shading, self.kind
        reach = np.diag(1 / (self.shader.dims - 1)).astype(kind)
        differences = [self.value(position + along) - self.value(position - along) for along in reach]
        spacing = self.shader.spacing
        gradient = np.stack(differences, axis=-1) * kind(self.shader.range) / (2 * spacing / spacing.mean()).astype(kind)
        normal = unit(gradient)
        to_light = -unit(step * (self.dims * spacing).astype(kind))
        cosine = -dot(normal, to_light)
        # Both point away from the viewer.
        along_mirror = np.maximum(-dot(unit(2 * cosine * normal + to_light), to_light), 0)
        lit = cosine != 0
        highlight = np.where(lit, shading["specular"] * along_mirror ** kind(shading["shininess"]), 0)
        return (kind(shading["ambient"]) + kind(shading["diffuse"]) * np.abs(cosine)) * color + highlight.astype(kind)


def lookup(value, table):
    """A table as a texture: its entries are at the middles of texels."""
    at = np.clip(value * value.dtype.type(len(table)) - value.dtype.type(0.5), 0, len(table) - 1)
    i = np.minimum(at.astype(int), len(table) - 2)
    return mix(table[i], table[i + 1], at - i.astype(at.dtype))


def mix(a, b, share):
    return a + share * (b - a)


def dot(a, b):
    return (a * b).sum(-1, keepdims=True)


def unit(vectors):
    """Of length 1; 0 stays 0."""
    length = np.sqrt(dot(vectors, vectors))
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
