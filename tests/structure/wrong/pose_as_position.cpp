// expect: cambium::geometry::Point: a pose is no point; write pose.position(), and give its heading
void add(Sim& world, cambium::geometry::Pose const& pose) { world.add({.position = pose, .speed = 3.0}); }
