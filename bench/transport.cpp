// The peer of transport.lisp: the kitchen and a plan of fifteen actions in plain C++ on Bullet.
//
// Usage: transport [N1 ... N15], the number of steps (1/240 s) of each action.  Prints the seconds
// of processor time of the whole run and of building the world, the number of steps, how many items
// ended on the table and how many were seen.
//
// The scene is that of models/kitchen/, the robot has as many links as models/robot/.  The robot
// finds three items (drives to the counter, asks 200 rays whether the item is seen), picks each up
// and delivers it (drives to the table, puts it down); drives to a drawer and opens it, does the
// same with the item in it, and closes it.  Every step moves all links as kinematic bodies.  A held
// item hangs on a fixed constraint with joint feedback, drawers on sliders.  There is no planning:
// no inverse kinematics, no search for paths, no test whether the robot collides with anything.

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

static_assert(sizeof(btScalar) == 8, "link the float64 build of Bullet");

namespace {

const double kTimeStep = 1.0 / 240;
const int kActions = 15;

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

btTransform at(double x, double y, double z, double yaw = 0) {
  return btTransform(btQuaternion(btVector3(0, 0, 1), yaw), btVector3(x, y, z));
}

struct Box {
  double x, y, z, size_x, size_y, size_z;
};

// The world as the shim of bullet-ffi/ has it: pools, solver, sleeping thresholds, filters.
class Kitchen {
 public:
  Kitchen() {
    gDeactivationTime = 0.2;
    world_.setGravity(btVector3(0, 0, -9.81));
    world_.setForceUpdateAllAabbs(false);
    add(keep(new btStaticPlaneShape(btVector3(0, 0, 1), 0)), at(0, 0, 0), 0, false);
    add_fixtures();
    for (int i = 0; i < 3; i++) add_drawer(0.6 * (i - 1));
    add_robot();
    items.push_back(add(bowl(), at(-2.1, -0.6, 0.8835), 0.45, false));
    items.push_back(add(box(0.147, 0.058, 0.224), at(-2.1, -0.2, 0.962, M_PI / 2), 0.4, false));
    items.push_back(add(box(0.064, 0.065, 0.194), at(-2.1, 0.1, 0.947), 1, false));
    items.push_back(add(compound({{0.075, 0, -0.0025, 0.06, 0.042, 0.014},
                                  {-0.03, 0, 0.0065, 0.15, 0.012, 0.006},
                                  {-0.0975, 0, -0.003, 0.015, 0.012, 0.013}}),
                        at(-2.12, 0, 0.6095, M_PI / 2), 0.05, false));
  }

  ~Kitchen() {
    release();
    for (auto &slider : sliders) world_.removeConstraint(slider.get());
    for (auto &body : bodies_) world_.removeRigidBody(body.get());
  }

  // Move the robot's links to where the base and the hand are, so that they have velocities.
  void pose_robot(double x, double y, double yaw, const btVector3 &hand) {
    const btTransform base = at(x, y, 0, yaw);
    const btVector3 shoulder(0.05, 0.188, 0.79);
    for (size_t i = 0; i < links.size(); i++) {
      btTransform pose = base * rest_[i];
      if (reach_[i] >= 0) pose.setOrigin(base * (shoulder + reach_[i] * (hand - shoulder)));
      links[i]->setWorldTransform(pose);
      links[i]->activate(true);
    }
  }

  void step() {
    world_.stepSimulation(kTimeStep, 0, kTimeStep);
    if (hold_) largest_force_ = std::max(largest_force_, feedback_.m_appliedForceBodyB.length());
  }

  void grip(btRigidBody &item) {
    btRigidBody &palm = *links[kPalm];
    item.activate(true);
    item.setActivationState(DISABLE_DEACTIVATION);
    for (btRigidBody *link : links) item.setIgnoreCollisionCheck(link, true);
    hold_.reset(new btFixedConstraint(palm, item,
                                      palm.getWorldTransform().inverse() * item.getWorldTransform(),
                                      btTransform::getIdentity()));
    hold_->setJointFeedback(&feedback_);
    world_.addConstraint(hold_.get(), true);
    held_ = &item;
  }

  void release() {
    if (!hold_) return;
    world_.removeConstraint(hold_.get());
    hold_.reset();
    for (btRigidBody *link : links) held_->setIgnoreCollisionCheck(link, false);
    held_->forceActivationState(ACTIVE_TAG);
    held_->setDeactivationTime(0);
  }

  // Return how many of 200 rays from the head meet the item.
  int look(const btRigidBody &item) const {
    const btVector3 camera = links[kCamera]->getWorldTransform().getOrigin();
    btVector3 low, high;
    item.getAabb(low, high);
    int seen = 0;
    for (int i = 0; i < 200; i++) {
      const btVector3 part(i / 200.0, std::fmod(i * 0.618034, 1), std::fmod(i * 0.414214, 1));
      const btVector3 to = camera + 1.02 * (low + (high - low) * part - camera);
      btCollisionWorld::ClosestRayResultCallback result(camera, to);
      result.m_collisionFilterMask =
          btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::KinematicFilter;
      world_.rayTest(camera, to, result);
      seen += result.m_collisionObject == &item;
    }
    return seen;
  }

  void drive_drawer(int number, double velocity) {
    sliders[number]->getRigidBodyB().activate(true);
    sliders[number]->setTargetLinMotorVelocity(velocity);
    sliders[number]->setMaxLinMotorForce(velocity == 0 ? 4 : 60);
  }

  std::vector<btRigidBody *> items, links;
  std::vector<std::unique_ptr<btSliderConstraint>> sliders;

 private:
  static const int kCamera = 4, kPalm = 12;

  btCollisionShape *keep(btCollisionShape *shape) {
    shapes_.emplace_back(shape);
    return shape;
  }
  btCollisionShape *box(double x, double y, double z) {
    return keep(new btBoxShape(btVector3(x / 2, y / 2, z / 2)));
  }
  btCollisionShape *cylinder(double radius, double length) {
    return keep(new btCylinderShapeZ(btVector3(radius, radius, length / 2)));
  }
  btCollisionShape *compound(const std::vector<Box> &boxes) {
    btCompoundShape *shape = new btCompoundShape;
    keep(shape);
    for (const Box &b : boxes)
      shape->addChildShape(at(b.x, b.y, b.z), box(b.size_x, b.size_y, b.size_z));
    return shape;
  }

  // A disc and a ring of twelve panels that lean outwards.
  btCollisionShape *bowl() {
    btCompoundShape *shape = new btCompoundShape;
    keep(shape);
    shape->addChildShape(at(0, 0, -0.0295), cylinder(0.044, 0.008));
    btCollisionShape *panel = box(0.005, 0.0327, 0.0645);
    for (int i = 0; i < 12; i++) {
      const btTransform lean(btQuaternion(btVector3(0, 1, 0), 0.4151), btVector3(0.055, 0, 0.004));
      shape->addChildShape(at(0, 0, 0, i * M_PI / 6) * lean, panel);
    }
    return shape;
  }

  btRigidBody *add(btCollisionShape *shape, const btTransform &pose, double mass, bool kinematic) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
    info.m_startWorldTransform = pose;
    info.m_linearSleepingThreshold = 0.01;
    info.m_angularSleepingThreshold = 0.05;
    info.m_friction = 0.7;
    bodies_.emplace_back(new btRigidBody(info));
    btRigidBody *body = bodies_.back().get();
    const int fixed = btBroadphaseProxy::StaticFilter | btBroadphaseProxy::KinematicFilter;
    const int all = btBroadphaseProxy::AllFilter;
    if (kinematic) body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    if (mass > 0)
      world_.addRigidBody(body, btBroadphaseProxy::DefaultFilter, all);
    else
      world_.addRigidBody(body, kinematic ? btBroadphaseProxy::KinematicFilter
                                          : btBroadphaseProxy::StaticFilter,
                          all & ~fixed);
    return body;
  }

  void add_fixtures() {
    add(compound({{-2.55, 0, 1.25, 0.1, 4.2, 2.5}, {2.55, 0, 1.25, 0.1, 4.2, 2.5},
                  {0, -2.05, 1.25, 5, 0.1, 2.5}, {0, 2.05, 1.25, 5, 0.1, 2.5}}),
        at(0, 0, 0), 0, false);
    add(compound({{0, 0, 0.004, 0.1, 4, 0.008}}), at(-0.6, 0, 0), 0, false);
    add(compound({{0.04, 0, 0.83, 0.08, 2, 0.04}, {0.49, 0, 0.83, 0.22, 2, 0.04},
                  {0.23, -0.275, 0.83, 0.3, 1.45, 0.04}, {0.23, 0.975, 0.83, 0.3, 0.05, 0.04},
                  {0.23, 0.7, 0.755, 0.3, 0.5, 0.01}, {0.085, 0.7, 0.785, 0.01, 0.5, 0.05},
                  {0.375, 0.7, 0.785, 0.01, 0.5, 0.05}, {0.23, 0.455, 0.785, 0.28, 0.01, 0.05},
                  {0.23, 0.945, 0.785, 0.28, 0.01, 0.05}, {0.285, 0, 0.28, 0.57, 2, 0.56},
                  {0.285, -0.3, 0.685, 0.57, 0.04, 0.25}, {0.285, 0.3, 0.685, 0.57, 0.04, 0.25},
                  {0.285, -0.95, 0.685, 0.57, 0.1, 0.25}, {0.285, 0.95, 0.685, 0.57, 0.1, 0.25},
                  {0.01, 0, 0.685, 0.02, 1.8, 0.25}, {0.585, 0, 0.7775, 0.02, 1.9, 0.065}}),
        at(-2.5, 0, 0), 0, false);
    add(compound({{0, 0, 0.73, 0.8, 1.6, 0.04}, {-0.35, -0.75, 0.355, 0.06, 0.06, 0.71},
                  {-0.35, 0.75, 0.355, 0.06, 0.06, 0.71}, {0.35, -0.75, 0.355, 0.06, 0.06, 0.71},
                  {0.35, 0.75, 0.355, 0.06, 0.06, 0.71}}),
        at(0.5, 0, 0), 0, false);
  }

  void add_drawer(double y) {
    const btTransform pose = at(-1.9, y, 0.66);
    btRigidBody *drawer = add(
        compound({{-0.22, 0, -0.065, 0.4, 0.474, 0.01}, {-0.426, 0, -0.005, 0.012, 0.474, 0.13},
                  {-0.22, 0.231, 0, 0.4, 0.012, 0.12}, {-0.22, -0.231, 0, 0.4, 0.012, 0.12},
                  {-0.01, 0, -0.002, 0.02, 0.55, 0.156}, {0.045, 0, 0, 0.012, 0.16, 0.012},
                  {0.02, 0.07, 0, 0.04, 0.012, 0.012}, {0.02, -0.07, 0, 0.04, 0.012, 0.012}}),
        pose, 2.6, false);
    for (size_t i = 0; i < 5; i++) drawer->setIgnoreCollisionCheck(bodies_[i].get(), true);
    sliders.emplace_back(
        new btSliderConstraint(anchor_, *drawer, pose, btTransform::getIdentity(), true));
    btSliderConstraint &slider = *sliders.back();
    slider.setLowerLinLimit(0);
    slider.setUpperLinLimit(0.4);
    slider.setLowerAngLimit(0);
    slider.setUpperAngLimit(0);
    slider.setPoweredLinMotor(true);
    slider.setTargetLinMotorVelocity(0);
    slider.setMaxLinMotorForce(4);
    world_.addConstraint(&slider, true);
  }

  // REACH is where the link is on the way from the shoulder to the hand, negative if it is no part
  // of the arm that moves.
  void add_link(btCollisionShape *shape, const btTransform &rest, double reach = -1) {
    links.push_back(add(shape, rest, 0, true));
    // The arm of this peer is straight and would hit the drawers that it reaches into.
    for (auto &slider : sliders)
      links.back()->setIgnoreCollisionCheck(&slider->getRigidBodyB(), true);
    rest_.push_back(rest);
    reach_.push_back(reach);
  }

  void add_robot() {
    add_link(compound({{0, 0, 0.17, 0.67, 0.67, 0.3}, {-0.07, 0, 0.51, 0.34, 0.24, 0.38}}),
             at(0, 0, 0));
    add_link(compound({{-0.14, 0, 0.05, 0.2, 0.24, 0.5}}), at(0, 0, 0.79));
    add_link(cylinder(0.06, 0.06), at(-0.07, 0, 1.16));
    add_link(box(0.12, 0.26, 0.1), at(-0.02, 0, 1.26));
    add_link(box(0.02, 0.2, 0.05), at(0.05, 0, 1.26));
    for (int side = 1; side >= -1; side -= 2) {
      const double y = side * 0.188;
      const auto arm_link = [&](btCollisionShape *shape, double part) {
        add_link(shape, at(0.05 + 0.6 * part, y, 0.95), side > 0 ? part : -1);
      };
      arm_link(cylinder(0.06, 0.2), 0);
      arm_link(cylinder(0.055, 0.11), 0.12);
      arm_link(box(0.28, 0.1, 0.1), 0.3);
      arm_link(cylinder(0.05, 0.1), 0.5);
      arm_link(box(0.22, 0.08, 0.08), 0.65);
      arm_link(cylinder(0.035, 0.07), 0.82);
      arm_link(cylinder(0.03, 0.04), 0.9);
      arm_link(box(0.05, 0.13, 0.05), 1);
      arm_link(box(0.08, 0.012, 0.024), 1.05);
      arm_link(box(0.08, 0.012, 0.024), 1.06);
    }
  }

  btDefaultCollisionConfiguration configuration_{small_pools()};
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  // A body of our own: Bullet's constructors for joints of one body share one in the process.
  btRigidBody anchor_{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, nullptr)};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btTransform> rest_;
  std::vector<double> reach_;
  std::unique_ptr<btFixedConstraint> hold_;
  btJointFeedback feedback_;
  btRigidBody *held_ = nullptr;
  btScalar largest_force_ = 0;
};

// The robot's actions, each of a given number of steps.
class Plan {
 public:
  explicit Plan(Kitchen &kitchen) : kitchen_(kitchen) { pose(); }

  void drive(double x, double y, double yaw, int steps) {
    const double x0 = x_, y0 = y_, yaw0 = yaw_;
    for (int i = 1; i <= steps; i++) {
      const double part = smooth(double(i) / steps);
      x_ = x0 + part * (x - x0);
      y_ = y0 + part * (y - y0);
      yaw_ = yaw0 + part * (yaw - yaw0);
      step();
    }
  }

  void reach(const btVector3 &goal, int steps) {
    const btVector3 start = hand_;
    for (int i = 1; i <= steps; i++) {
      hand_ = start.lerp(goal, smooth(double(i) / steps));
      step();
    }
  }

  void move_drawer(int number, double distance, int steps) {
    const int third = steps / 3;
    const btVector3 handle = local(kitchen_.sliders[number]->getRigidBodyB()) +
                             btVector3(-0.15, 0, 0);
    reach(handle, third);
    kitchen_.drive_drawer(number, distance / (third * kTimeStep));
    reach(handle + btVector3(-distance, 0, 0), third);
    kitchen_.drive_drawer(number, 0);
    reach(kCarry, steps - 2 * third);
  }

  int find(const btRigidBody &item, int steps) {
    drive(-1.25, item.getWorldTransform().getOrigin().y() - 0.188, M_PI, steps);
    return kitchen_.look(item);
  }

  void pick_up(btRigidBody &item, int steps) {
    const btVector3 place = local(item);
    reach(place + btVector3(-0.2, 0, 0.05), steps / 4);
    reach(place + btVector3(-0.1, 0, 0.02), steps / 4);
    kitchen_.grip(item);
    reach(place + btVector3(-0.1, 0, 0.15), steps / 4);
    reach(kCarry, steps - 3 * (steps / 4));
  }

  void deliver(const btRigidBody &item, double y, double height, int steps) {
    const int part = steps / 5;
    drive(-0.4, y - 0.188, 0, steps - 3 * part);
    // The hand keeps its place relative to the item's.
    const btVector3 grasp = hand_ - local(item), place = btVector3(0.75, 0.188, height) + grasp;
    reach(place + btVector3(0, 0, 0.1), part / 2);
    reach(place, part - part / 2);
    kitchen_.release();
    reach(place + btVector3(-0.12, 0, 0.05), part);
    reach(kCarry, part);
  }

  long steps = 0;

 private:
  const btVector3 kCarry{0.5, 0.2, 1.05};

  static double smooth(double part) { return part * part * (3 - 2 * part); }

  btVector3 local(const btRigidBody &body) const {
    return at(x_, y_, 0, yaw_).inverse() * body.getWorldTransform().getOrigin();
  }
  void pose() { kitchen_.pose_robot(x_, y_, yaw_, hand_); }
  void step() {
    pose();
    kitchen_.step();
    steps++;
  }

  Kitchen &kitchen_;
  double x_ = -1.1, y_ = 0, yaw_ = M_PI;
  btVector3 hand_{0.5, 0.2, 1.05};
};

}  // namespace

int main(int argc, char **argv) {
  int steps[kActions];
  if (argc != 1 && argc != kActions + 1) {
    std::fprintf(stderr, "usage: transport [N1 ... N%d]\n", kActions);
    return 2;
  }
  for (int &count : steps) count = 1200;
  for (int i = 1; i < argc; i++) steps[i - 1] = std::max(10, std::atoi(argv[i]));

  const double begin = processor_seconds();
  Kitchen kitchen;
  const double built = processor_seconds();
  Plan plan(kitchen);
  const double heights[] = {0.7835, 0.862, 0.847, 0.7595};
  int next = 0, seen = 0;
  for (int i = 0; i < 4; i++) {
    if (i == 3) {
      plan.drive(-1.1, 0.3, M_PI, steps[next++]);
      plan.move_drawer(1, 0.3, steps[next++]);
    }
    btRigidBody &item = *kitchen.items[i];
    seen += plan.find(item, steps[next++]) > 20;
    plan.pick_up(item, steps[next++]);
    plan.deliver(item, 0.35 * i - 0.6, heights[i] + 0.002, steps[next++]);
  }
  plan.drive(-1.1, 0.3, M_PI, steps[next] / 2);
  plan.move_drawer(1, -0.3, steps[next] - steps[next] / 2);
  const double end = processor_seconds();

  int on_table = 0;
  for (const btRigidBody *item : kitchen.items) {
    const btVector3 place = item->getWorldTransform().getOrigin();
    on_table += place.x() > 0.1 && place.z() > 0.74;
  }
  std::printf("%.6f %.6f %ld %d %d\n", end - begin, built - begin, plan.steps, on_table, seen);
  return 0;
}
