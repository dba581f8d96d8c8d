"""Reference of co5_published_speed.yaml: one oblique impact on a rigid plane by Hertz's normal force, Mindlin's initial shear
stiffness and Coulomb's limit, in 400 000 steps to a contact, written without any of scree's code. Prints x and R w/(mu v_n).

    python3 co5_impact.py HZ_MODE [SPEED]
"""
import math
import sys

YOUNG, NU, DENSITY, R, MU = 2.08e11, 0.3, 7850, 1e-5, 0.3


def impact(speed, x, mode, steps=400000):
    mass = 4 / 3 * math.pi * R**3 * DENSITY
    inertia = 0.4 * mass * R**2
    h = 4 / 3 * YOUNG / (1 - NU**2) * math.sqrt(R)
    dt = 2.9432 * (5 * mass * speed**2 / (4 * h)) ** 0.4 / speed / steps
    depth, normal, along, spin, shear, before = 0.0, speed, x * MU * speed, 0.0, 0.0, 0.0
    while True:
        depth += normal * dt
        if depth <= 0:
            return R * spin / (MU * speed)
        lever, push = R - depth / 2, h * depth**1.5
        stiffness = 2 * (1 - NU) / (2 - NU) * 1.5 * h * math.sqrt(depth)
        if before > 0 and (mode == 2 or (mode == 1 and stiffness < before)):
            shear *= stiffness / before
        shear -= stiffness * (along + spin * lever) * dt
        shear = max(-MU * push, min(MU * push, shear))
        before = stiffness
        normal -= push / mass * dt
        along += shear / mass * dt
        spin += shear * lever / inertia * dt


if __name__ == "__main__":
    for point in (0.994, 1.341, 2, 2.988, 3.994, 5, 6.006, 10, 20):
        print(point, "%.5f" % impact(float(sys.argv[2]) if len(sys.argv) > 2 else 5.0, point, int(sys.argv[1])))
