#include "src/cli.h"
#include "src/interrupt.h"

int main(int argc, char** argv) {
    fidservo::watch_for_interrupts();
    return fidservo::run_command_line(argc, argv);
}
