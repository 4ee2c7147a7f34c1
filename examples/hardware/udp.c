/* A controller behind a UDP socket of this computer: what a real-time computer beside the blade would run.
 *
 * Compile with the folder of lqg.c: cc -std=c99 -O2 -I. udp.c -o udp -lm. It prints its port, answers each packet [k, sensors] with
 * [k, volts], all double, and ends at an empty packet, or when none has come for five seconds.
 */
#define _POSIX_C_SOURCE 200112L
#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "lqg.c"

int main(void)
{
    static lqg_state state;
    double asked[1 + LQG_SENSORS], answer[1 + LQG_VOLTAGES];
    const struct timeval patience = {5, 0};
    struct sockaddr_in own, other;
    socklen_t size = sizeof own;
    const int link = socket(AF_INET, SOCK_DGRAM, 0);

    memset(&own, 0, sizeof own);
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (link < 0 || bind(link, (struct sockaddr *)&own, sizeof own)) return 1;
    if (setsockopt(link, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience)) return 1;
    if (getsockname(link, (struct sockaddr *)&own, &size)) return 1;
    printf("%d\n", ntohs(own.sin_port));
    fflush(stdout);

    lqg_init(&state);
    for (;;) {
        ssize_t length;
        size = sizeof other;
        length = recvfrom(link, asked, sizeof asked, 0, (struct sockaddr *)&other, &size);
        if (length < 0) return 2; /* nobody asks any more */
        if (length == 0) return 0;
        if (length != (ssize_t)sizeof asked || lqg_step(&state, asked + 1, answer + 1)) continue; /* no answer: drive stays as it is */
        answer[0] = asked[0];
        sendto(link, answer, sizeof answer, 0, (struct sockaddr *)&other, size);
    }
}
