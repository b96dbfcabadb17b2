"""Scenes that peers solve: data, options common to their scripts, and the line by which a script reports. Plain Python: every peer's interpreter reads it."""
import argparse
import dataclasses
import json


@dataclasses.dataclass
class Scene:
    press: float = 0  # how far the top comes down
    slide: float = 0  # how far it is then moved along
    E: float = 1
    nu: float = 0.3
    dim: int = 2
    fold: int = 1  # what is modelled is one of so many equal parts
    friction: float = 0
    width: float = 1  # half width of the block
    height: float = 1

    @property
    def mu(self):
        return self.E / 2 / (1 + self.nu)

    @property
    def kappa(self):
        return self.E / 3 / (1 - 2 * self.nu)

    @property
    def half(self):
        return not self.slide


SCENES = {  # a half disc (ball) of radius 1 on a block, plane strain, neo-Hookean, U = kappa/2 (J-1)^2
    "hertz2d": Scene(press=0.05, fold=2),
    "rubber2d": Scene(press=0.3, nu=0.499, fold=2),
    "hertz3d": Scene(press=0.05, dim=3, fold=4),
    "slide2d": Scene(press=0.1, slide=0.5, width=2),
    "friction2d": Scene(press=0.1, slide=0.5, width=2, friction=0.3),
    "mindlin": Scene(press=0.01, slide=0.0012, width=2, height=2, friction=0.3),
}
CYLINDER = dict(radius=0.2, press=0.1, c1=0.293e6, c2=0.177e6, kappa=1.41e9)  # P-9, a quarter: force of the whole per length is twice that of the quarter
COOK = dict(mu=80.1938, traction=6.25, corners=((0, 0), (48, 44), (48, 60), (0, 44)))  # O-10 with kappa infinite


def options(description, **defaults):
    """Options of a peer's script: --scene, and one for each default, of its type."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--scene", required=True)
    for name, value in defaults.items():
        parser.add_argument(f"--{name}", type=type(value), default=value)
    return parser.parse_args()


def report(value, unknowns, iterations, steps, **more):
    """The last line of a script that has found an answer."""
    print("RESULT " + json.dumps(dict(value=float(value), unknowns=int(unknowns), iterations=int(iterations), steps=int(steps), **more)), flush=True)
