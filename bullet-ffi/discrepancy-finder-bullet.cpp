// Worlds, shapes and bodies of the Bullet shim; the API is in discrepancy-finder-bullet.h.
//
// The shim is one translation unit in five parts: world.inc has the data structures and the guard
// that every entry passes, this file worlds, shapes and bodies, constraints.inc attachments and
// ignored collisions, queries.inc and rays.inc all that looks and does not touch.

#include "discrepancy-finder-bullet.h"
#include "world.inc"
#include "constraints.inc"
#include "queries.inc"
#include "rays.inc"

namespace {

int add_shape(dfb_world *world, std::unique_ptr<btCollisionShape> shape) {
  world->shapes.push_back(std::move(shape));
  return static_cast<int>(world->shapes.size()) - 1;
}

void count_slow_steps(dfb_world *world) {
  for (int id : world->dynamic_bodies) {
    Body &body = world->bodies[id];
    const bool slow = body.rigid->getLinearVelocity().length2() < 1e-6 &&
                      body.rigid->getAngularVelocity().length2() < 1e-4;
    body.slow_steps = slow ? body.slow_steps + 1 : 0;
  }
}

void place(dfb_world *world, Body &body, const btTransform &pose) {
  const btVector3 zero(0, 0, 0);
  btRigidBody &rigid = *body.rigid;
  wake_touching(world, rigid);
  rigid.setWorldTransform(pose);
  rigid.setInterpolationWorldTransform(pose);
  rigid.setLinearVelocity(zero);
  rigid.setAngularVelocity(zero);
  rigid.setInterpolationLinearVelocity(zero);
  rigid.setInterpolationAngularVelocity(zero);
  rigid.clearForces();
  rigid.updateInertiaTensor();
  // Contacts of the old place would push once more from afar.
  world->broadphase.getOverlappingPairCache()->cleanProxyFromPairs(rigid.getBroadphaseProxy(),
                                                                   &world->dispatcher);
  world->dynamics.updateSingleAabb(&rigid);
  if (body.kind != DFB_STATIC) rigid.activate(true);
  body.slow_steps = 0;
}

}  // namespace

extern "C" {

dfb_world *dfb_world_new(double gravity, double time_step) {
  FloatEnvironment guard;
  if (!usable(gravity) || !positive(time_step)) return nullptr;
  try {
    return new dfb_world(gravity, time_step);
  } catch (...) {
    return nullptr;
  }
}

int dfb_world_delete(dfb_world *world) {
  return enter(world, [&] {
    delete world;
    return DFB_OK;
  });
}

int dfb_step(dfb_world *world, int steps) {
  return enter(world, [&] {
    if (steps < 0) return DFB_BAD_NUMBER;
    for (int i = 0; i < steps; i++) {
      // No substeps: Bullet then takes the time step as it is and keeps no remainder of time.
      world->dynamics.stepSimulation(world->time_step, 0, world->time_step);
      count_slow_steps(world);
    }
    world->bounds_known = false;
    return DFB_OK;
  });
}

int dfb_shape_box(dfb_world *world, double x, double y, double z) {
  return enter(world, [&]() -> int {
    if (!positive(x) || !positive(y) || !positive(z)) return DFB_BAD_NUMBER;
    return add_shape(world, std::make_unique<btBoxShape>(btVector3(x / 2, y / 2, z / 2)));
  });
}

int dfb_shape_sphere(dfb_world *world, double radius) {
  return enter(world, [&]() -> int {
    if (!positive(radius)) return DFB_BAD_NUMBER;
    return add_shape(world, std::make_unique<btSphereShape>(radius));
  });
}

int dfb_shape_cylinder(dfb_world *world, double radius, double height) {
  return enter(world, [&]() -> int {
    if (!positive(radius) || !positive(height)) return DFB_BAD_NUMBER;
    return add_shape(world,
                     std::make_unique<btCylinderShapeZ>(btVector3(radius, radius, height / 2)));
  });
}

int dfb_shape_plane(dfb_world *world, double nx, double ny, double nz, double d) {
  return enter(world, [&]() -> int {
    if (!usable(nx) || !usable(ny) || !usable(nz) || !usable(d) ||
        !unit(nx * nx + ny * ny + nz * nz))
      return DFB_BAD_NUMBER;
    return add_shape(world, std::make_unique<btStaticPlaneShape>(btVector3(nx, ny, nz), d));
  });
}

int dfb_shape_compound(dfb_world *world, int count, const int *children, const double *poses) {
  return enter(world, [&]() -> int {
    if (count < 1) return DFB_BAD_SHAPE;
    auto compound = std::make_unique<btCompoundShape>(true, count);
    for (int i = 0; i < count; i++) {
      if (children[i] < 0 || children[i] >= static_cast<int>(world->shapes.size()))
        return DFB_BAD_SHAPE;
      btCollisionShape *child = world->shapes[children[i]].get();
      if (!child->isConvex()) return DFB_BAD_SHAPE;
      const double *p = poses + 7 * i;
      btTransform pose;
      if (!make_pose(pose, p[0], p[1], p[2], p[3], p[4], p[5], p[6])) return DFB_BAD_NUMBER;
      compound->addChildShape(pose, child);
    }
    return add_shape(world, std::move(compound));
  });
}

int dfb_body_new(dfb_world *world, int shape, int kind, double x, double y, double z, double qx,
                 double qy, double qz, double qw, double mass, double ix, double iy, double iz,
                 double friction, double rolling_friction, double restitution) {
  return enter(world, [&]() -> int {
    if (shape < 0 || shape >= static_cast<int>(world->shapes.size())) return DFB_BAD_SHAPE;
    btCollisionShape *form = world->shapes[shape].get();
    const bool dynamic = kind == DFB_DYNAMIC;
    if (!dynamic && kind != DFB_STATIC && kind != DFB_KINEMATIC) return DFB_BAD_KIND;
    if (form->getShapeType() == STATIC_PLANE_PROXYTYPE && kind != DFB_STATIC) return DFB_BAD_KIND;
    btTransform pose;
    if (!make_pose(pose, x, y, z, qx, qy, qz, qw)) return DFB_BAD_NUMBER;
    if (dynamic && (!positive(mass) || !positive(ix) || !positive(iy) || !positive(iz)))
      return DFB_BAD_NUMBER;
    if (!usable(friction) || friction < 0 || !usable(rolling_friction) || rolling_friction < 0 ||
        !usable(restitution) || restitution < 0 || restitution > 1)
      return DFB_BAD_NUMBER;

    btRigidBody::btRigidBodyConstructionInfo info(dynamic ? mass : 0, nullptr, form,
                                                  btVector3(ix, iy, iz));
    info.m_startWorldTransform = pose;
    info.m_friction = friction;
    info.m_rollingFriction = rolling_friction;
    info.m_spinningFriction = rolling_friction;
    info.m_restitution = restitution;
    info.m_linearSleepingThreshold = kSleepSpeed;
    info.m_angularSleepingThreshold = kSleepTurn;
    Body body;
    body.kind = kind;
    body.rigid = std::make_unique<btRigidBody>(info);
    if (kind == DFB_KINEMATIC)
      body.rigid->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    const int fixed = btBroadphaseProxy::StaticFilter | btBroadphaseProxy::KinematicFilter;
    const int group = dynamic               ? btBroadphaseProxy::DefaultFilter
                      : kind == DFB_STATIC ? btBroadphaseProxy::StaticFilter
                                           : btBroadphaseProxy::KinematicFilter;
    const int all = btBroadphaseProxy::AllFilter;
    const int id = static_cast<int>(world->bodies.size());
    if (dynamic) world->dynamic_bodies.reserve(world->dynamic_bodies.size() + 1);
    world->bodies.push_back(std::move(body));
    if (dynamic) world->dynamic_bodies.push_back(id);
    world->dynamics.addRigidBody(world->bodies[id].rigid.get(), group,
                                 dynamic ? all : all & ~fixed);
    world->bounds_known = false;
    return id;
  });
}

int dfb_body_move(dfb_world *world, int id, double x, double y, double z, double qx, double qy,
                  double qz, double qw) {
  return enter_lightly(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    if (body->kind != DFB_KINEMATIC) return DFB_BAD_KIND;
    btTransform pose;
    if (!make_pose(pose, x, y, z, qx, qy, qz, qw)) return DFB_BAD_NUMBER;
    // An awake kinematic body wakes what it touches in the next step; one that slept may be gone
    // from there by then.
    if (!body->rigid->isActive()) wake_touching(world, *body->rigid);
    body->rigid->setWorldTransform(pose);
    body->rigid->activate(true);
    world->bounds_known = false;
    return DFB_OK;
  });
}

int dfb_body_place(dfb_world *world, int id, double x, double y, double z, double qx, double qy,
                   double qz, double qw) {
  return enter(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    btTransform pose;
    if (!make_pose(pose, x, y, z, qx, qy, qz, qw)) return DFB_BAD_NUMBER;
    place(world, *body, pose);
    world->bounds_known = false;
    return DFB_OK;
  });
}

int dfb_body_wake(dfb_world *world, int id) {
  return enter(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    if (body->kind == DFB_DYNAMIC) body->rigid->activate(true);
    return DFB_OK;
  });
}

int dfb_body_allow_sleep(dfb_world *world, int id, int flag) {
  return enter(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    if (body->kind != DFB_DYNAMIC) return DFB_BAD_KIND;
    body->may_sleep = flag != 0;
    refresh_activation(*body);
    return DFB_OK;
  });
}

}  // extern "C"

#include "mechanisms.inc"
#include "kinematics.inc"
