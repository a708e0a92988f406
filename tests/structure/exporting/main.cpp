double place_after_a_second(double speed);

int main() { return place_after_a_second(20.0) == 30.0 ? 0 : 1; }
