# S5 many times over in YADE: the pairs of D/impact_<N>_<n>.csv. env: N balls, P steps per contact, D, DT, S steps
import os
from yade import timing, utils
N,P,S=(int(os.environ[k]) for k in 'NPS'); dt=float(os.environ['DT'])
m=O.materials.append(FrictMat(density=2500,young=1e7,poisson=.3,frictionAngle=0))
for l in open('%s/impact_%d_%d.csv'%(os.environ['D'],N,P)).read().split('\n')[1:]:
    if not l.strip(): continue
    q=[float(v) for v in l.split(',')]
    i=O.bodies.append(utils.sphere(q[2:5],q[5],material=m)); O.bodies[i].state.vel=Vector3(*q[6:9])
O.engines=[ForceResetter(),InsertionSortCollider([Bo1_Sphere_Aabb()],verletDist=5e-4),InteractionLoop([Ig2_Sphere_Sphere_ScGeom()],[Ip2_FrictMat_FrictMat_MindlinPhys()],[Law2_ScGeom_MindlinPhys_Mindlin()]),NewtonIntegrator(damping=0)]
# Waiting for the end of a run looks every 40 ms only: the engines' own clocks say how long they took.
# The first step sorts all balls, which other codes do before their loop; no pair meets in it.
O.dt=dt; O.run(1,True); O.timingEnabled=True; timing.reset(); O.run(S-1,True); t=sum(e.execTime for e in O.engines)*1e-9
print('RESULT %.6f %.6e'%(t,max(abs(b.state.vel.norm()/.5-1) for b in O.bodies)))
import sys; sys.stdout.flush(); os._exit(0)
