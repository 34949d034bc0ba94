// The peer of steps.lisp: the same scene stepped by plain C++ on Bullet.
//
// Usage: steps N.  Prints the number of steps a second of processor time, over N steps.  Pools,
// solver and flags are those of the shim in bullet-ffi/, so that the ratio of the two programs is
// what the way through the shim and Lisp costs.  Each step moves five kinematic boxes, advances
// the world and reads the state of all bodies: 13 doubles each.

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

static_assert(sizeof(btScalar) == 8, "link the float64 build of Bullet");

namespace {

const int kLinks = 5;
const double kTimeStep = 1.0 / 240;

double processor_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

btDefaultCollisionConstructionInfo small_pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 256;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 256;
  return info;
}

btTransform at(double x, double y, double z) {
  return btTransform(btQuaternion(0, 0, 0, 1), btVector3(x, y, z));
}

struct Scene {
  btDefaultCollisionConfiguration configuration{small_pools()};
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  // Data, as the quaternions are in Lisp, and no constant that the compiler folds into a matrix.
  btQuaternion turn{0, 0, 0, 1};

  Scene() {
    gDeactivationTime = 0.2;
    world.setGravity(btVector3(0, 0, -9.81));
    world.setForceUpdateAllAabbs(false);
    add(new btStaticPlaneShape(btVector3(0, 0, 1), 0), at(0, 0, 0), 0, false);
    add(new btBoxShape(btVector3(1.3, 0.15, 0.2)), at(1, 0.4, 0.2), 0, false);
    for (int link = 0; link < kLinks; link++)
      add(new btBoxShape(btVector3(0.05, 0.05, 0.1)), link_pose(link, 0), 0, true);
    add(new btBoxShape(btVector3(0.03, 0.03, 0.06)), at(1, 0.4, 0.46), 0.4, false);
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
  }

  ~Scene() {
    for (auto &body : bodies) world.removeRigidBody(body.get());
  }

  btRigidBody &link(int i) { return *bodies[2 + i]; }

  btTransform link_pose(int i, int step) const {
    return btTransform(turn, btVector3(0.25 * i + 0.0001 * (step % 1000), -0.5, 0.5));
  }

  void add(btCollisionShape *shape, const btTransform &pose, double mass, bool kinematic) {
    shapes.emplace_back(shape);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
    info.m_startWorldTransform = pose;
    info.m_linearSleepingThreshold = 0.01;
    info.m_angularSleepingThreshold = 0.05;
    bodies.emplace_back(new btRigidBody(info));
    if (kinematic) bodies.back()->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    const int fixed = btBroadphaseProxy::StaticFilter | btBroadphaseProxy::KinematicFilter;
    const int all = btBroadphaseProxy::AllFilter;
    if (mass > 0)
      world.addRigidBody(bodies.back().get(), btBroadphaseProxy::DefaultFilter, all);
    else
      world.addRigidBody(bodies.back().get(), kinematic ? btBroadphaseProxy::KinematicFilter
                                                        : btBroadphaseProxy::StaticFilter,
                         all & ~fixed);
  }

  void step(int number) {
    for (int i = 0; i < kLinks; i++) {
      link(i).setWorldTransform(link_pose(i, number));
      link(i).activate(true);
    }
    world.stepSimulation(kTimeStep, 0, kTimeStep);
  }

  void read(double *state) const {
    for (const auto &body : bodies) {
      const btTransform &pose = body->getWorldTransform();
      const btQuaternion turn = pose.getRotation();
      for (int i = 0; i < 3; i++) {
        state[i] = pose.getOrigin()[i];
        state[7 + i] = body->getLinearVelocity()[i];
        state[10 + i] = body->getAngularVelocity()[i];
      }
      for (int i = 0; i < 4; i++) state[3 + i] = turn[i];
      state += 13;
    }
  }
};

}  // namespace

int main(int argc, char **argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 0;
  if (steps < 1) {
    std::fprintf(stderr, "usage: steps N\n");
    return 2;
  }
  Scene scene;
  std::vector<double> state(13 * scene.bodies.size());
  for (int i = 0; i < 240; i++) scene.step(i);
  const double start = processor_seconds();
  for (int i = 0; i < steps; i++) {
    scene.step(i);
    scene.read(state.data());
  }
  const double seconds = processor_seconds() - start;
  // The height of the box that stands on the bench shows that both programs did the same.
  std::fprintf(stderr, "height %.17g\n", state[13 * (scene.bodies.size() - 1) + 2]);
  std::printf("%.1f\n", steps / seconds);
  return 0;
}
