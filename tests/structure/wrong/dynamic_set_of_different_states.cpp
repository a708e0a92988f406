// expect: the models must have the same State
int main() {
  cambium::DynamicSet<cambium::SingleTrack, cambium::TripleIntegrator> const set;
  return set.wheel_base() > 0.0;
}
